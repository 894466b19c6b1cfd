// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/Exr.h"

#include "Core/AtomicFile.h"
#include "Core/Error.h"

#include <Imath/ImathBox.h>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <exception>
#include <string>
#include <utility>

namespace inr {

namespace {

constexpr const char* ColorChannels[] = {"R", "G", "B", "A"};
constexpr const char* DepthChannel[] = {"Z"};
constexpr const char* SampleChannels[] = {"samples", "level"};

/// One channel of `image` as OpenEXR addresses it: EXR's first row is the top one, ours the bottom.
Imf::Slice SliceOf(Image& image, int channel)
{
  const auto pixelStride = static_cast<std::ptrdiff_t>(sizeof(float)) * image.channels;
  const std::ptrdiff_t rowStride = pixelStride * image.width;
  auto* bottom = reinterpret_cast<char*>(image.pixels.data() + channel);
  // The strides are unsigned in the interface and wrap as its own documentation has it.
  return {Imf::FLOAT, bottom + rowStride * (image.height - 1),
          static_cast<std::size_t>(pixelStride), static_cast<std::size_t>(-rowStride)};
}

bool Fits(const Image& image, int channels, const Image& rgba)
{
  return image.pixels.empty() ||
         (image.channels == channels && image.width == rgba.width && image.height == rgba.height);
}

/// Whether it has the values that its size takes.
bool IsWhole(const Image& image)
{
  const std::size_t values = static_cast<std::size_t>(image.width) *
                             static_cast<std::size_t>(image.height) *
                             static_cast<std::size_t>(image.channels);
  return image.pixels.empty() || image.pixels.size() == values;
}

void CheckShapes(const Image& rgba, const Image& depth, const Image& samples)
{
  if (rgba.channels != 4 || rgba.width < 1 || rgba.height < 1 || rgba.pixels.empty() ||
      !Fits(depth, 1, rgba) || !Fits(samples, 2, rgba) || !IsWhole(rgba) || !IsWhole(depth) ||
      !IsWhole(samples)) {
    throw Error(ErrorCode::InvalidArgument,
                "an EXR file takes RGBA and, of the same size, one channel of depth and two of "
                "samples and their level, each with all its values");
  }
}

void AddChannels(Imf::Header& header, Imf::FrameBuffer& buffer, Image& image,
                 const char* const names[])
{
  for (int c = 0; c < image.channels && !image.pixels.empty(); ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    buffer.insert(names[c], SliceOf(image, c));
  }
}

void WriteChannels(const std::string& path, Image& rgba, Image& depth, Image& samples)
{
  Imf::Header header(rgba.width, rgba.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer buffer;
  AddChannels(header, buffer, rgba, ColorChannels);
  AddChannels(header, buffer, depth, DepthChannel);
  AddChannels(header, buffer, samples, SampleChannels);
  Imf::OutputFile file(path.c_str(), header, 1);
  file.setFrameBuffer(buffer);
  file.writePixels(rgba.height);
}

} // namespace

void WriteExr(const std::string& path, const Image& rgba, const Image& depth, const Image& samples)
{
  CheckShapes(rgba, depth, samples);
  AtomicFile file(path);
  try {
    Image colors = rgba; // OpenEXR's slices are not const
    Image distances = depth;
    Image counts = samples;
    WriteChannels(file.temporaryPath(), colors, distances, counts);
  } catch (const std::exception& error) {
    throw Error(ErrorCode::CannotWrite, "cannot write '" + path + "': " + error.what());
  }
  file.commit();
}

Image ReadExr(const std::string& path, Image* depth, Image* samples)
{
  try {
    Imf::InputFile file(path.c_str(), 1);
    const Imath::Box2i window = file.header().dataWindow();
    if (window.min != Imath::V2i(0)) {
      throw Error(ErrorCode::Unsupported, "the data of '" + path + "' begin at pixel (" +
                                              std::to_string(window.min.x) + ", " +
                                              std::to_string(window.min.y) + "), not at (0, 0)");
    }
    const Imf::ChannelList& channels = file.header().channels();
    Image rgba(window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, 4);
    Image distances;
    Imf::FrameBuffer buffer;
    for (int c = 0; c < 4; ++c) {
      if (channels.findChannel(ColorChannels[c]) == nullptr) {
        throw Error(ErrorCode::Malformed, "'" + path + "' has no channel " + ColorChannels[c]);
      }
      buffer.insert(ColorChannels[c], SliceOf(rgba, c));
    }
    if (channels.findChannel("Z") != nullptr) {
      distances = Image(rgba.width, rgba.height, 1);
      buffer.insert("Z", SliceOf(distances, 0));
    }
    Image counts;
    if (channels.findChannel("samples") != nullptr && channels.findChannel("level") != nullptr) {
      counts = Image(rgba.width, rgba.height, 2);
      buffer.insert("samples", SliceOf(counts, 0));
      buffer.insert("level", SliceOf(counts, 1));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (depth != nullptr) {
      *depth = std::move(distances);
    }
    if (samples != nullptr) {
      *samples = std::move(counts);
    }
    return rgba;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::CannotRead, "cannot read '" + path + "': " + error.what());
  }
}

} // namespace inr
