// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/CompactBlobs.h"

#include "Core/Error.h"
#include "Core/Model/Compression.h"
#include "Core/Model/ModelBlobs.h"
#include "Core/Model/Quantised.h"

#include <algorithm>
#include <cmath>

namespace inr {
namespace {

constexpr int Planes = 2; // bytes of a number, low ones first
constexpr float LargestBound = 255.0f;

// Small numbers of either sign become small ones: 0, -1, 1, -2, ... are 0, 1, 2, 3, ...
std::uint16_t ZigZag(std::int16_t value)
{
  const auto twice = static_cast<std::uint16_t>(static_cast<std::uint16_t>(value) << 1);
  return value < 0 ? static_cast<std::uint16_t>(~twice) : twice;
}

std::int16_t FromZigZag(std::uint16_t code)
{
  const auto half = static_cast<std::uint16_t>(code >> 1);
  return static_cast<std::int16_t>((code & 1) != 0 ? ~half : half);
}

std::int16_t MultipleOf(float value, float step, std::uint64_t index)
{
  const double multiple = NearestMultiple(value, step);
  if (!(std::abs(multiple) <= LargestMultiple)) {
    throw Error(ErrorCode::InvalidModel, "parameter " + std::to_string(index) + " is " +
                                             std::to_string(value) +
                                             ", which its level's step cannot express; store the "
                                             "model in half or single precision");
  }
  return static_cast<std::int16_t>(multiple);
}

// The blob as it is in the file, counted in the checksum.
std::string Packed(const InputFile& file, const Blob& blob, std::uint32_t& checksum)
{
  std::string bytes;
  if (blob.inMemory) {
    bytes.assign(blob.bytes.begin(), blob.bytes.end());
  } else {
    bytes.resize(static_cast<std::size_t>(blob.size));
    file.read(blob.offset, bytes.data(), bytes.size());
  }
  checksum = ContinueChecksum(checksum, bytes.data(), bytes.size());
  return bytes;
}

// What the reader would refuse must not be written.
std::string PackedReadably(const std::string& plain, const std::vector<std::size_t>& boundaries,
                           Packing packing)
{
  std::string packed = Compress(plain, boundaries, packing);
  if (!MayExpand(static_cast<std::int64_t>(packed.size()),
                 static_cast<std::int64_t>(plain.size()))) {
    throw Error(ErrorCode::InvalidModel,
                "so much that is equal would not be accepted in a compact file; store the model in "
                "half precision");
  }
  return packed;
}

// Parameters that are distributed alike and lie together in the blob: a matrix, or one feature of a
// level.
struct Run
{
  std::uint64_t first; // parameter
  std::uint64_t stride;
  std::uint64_t count;
  std::size_t group;
};

std::vector<Run> RunsOf(const Description& description)
{
  const std::size_t matrices = Layout(description).layers.size();
  const std::vector<ParameterGroup> groups = ParameterGroups(description);
  std::vector<Run> runs;
  for (std::size_t k = 0; k < groups.size(); ++k) {
    const auto features = static_cast<std::uint64_t>(k < matrices ? 1 : description.grid.features);
    for (std::uint64_t feature = 0; feature < features; ++feature) {
      runs.push_back({groups[k].offset + feature, features, groups[k].count / features, k});
    }
  }
  return runs;
}

// Calls body(place in the blob, parameter, group) for every parameter.
template <typename Body> void ForEachParameter(const std::vector<Run>& runs, const Body& body)
{
  std::size_t place = 0;
  for (const Run& run : runs) {
    for (std::uint64_t k = 0; k < run.count; ++k) {
      body(place++, run.first + k * run.stride, run.group);
    }
  }
}

// Where runs end in the low bytes, then in the high ones.
std::vector<std::size_t> BoundariesOf(const std::vector<Run>& runs)
{
  std::vector<std::size_t> boundaries;
  std::size_t end = 0;
  for (int plane = 0; plane < Planes; ++plane) {
    for (const Run& run : runs) {
      boundaries.push_back(end += run.count);
    }
  }
  boundaries.pop_back(); // the end of it all
  return boundaries;
}

float Bound(std::uint8_t code) { return static_cast<float>(code) / LargestBound; }

// Rounding the product never carries a value over a bound: not even the floats next to one.
std::uint8_t BoundBelow(float value)
{
  return static_cast<std::uint8_t>(std::floor(std::clamp(value, 0.0f, 1.0f) * LargestBound));
}

std::uint8_t BoundAbove(float value)
{
  return static_cast<std::uint8_t>(std::ceil(std::clamp(value, 0.0f, 1.0f) * LargestBound));
}

} // namespace

std::int64_t PlainParameterBytes(std::uint64_t parameters)
{
  return static_cast<std::int64_t>(parameters) * Planes;
}

std::int64_t PlainRangeBytes(std::int64_t cells) { return 2 * cells; }

std::int64_t LargestQuantised(const Description& description)
{
  return CompressedBound(PlainParameterBytes(Layout(description).parameterCount),
                         Planes * RunsOf(description).size());
}

std::int64_t LargestCompactRanges(std::int64_t cells)
{
  return CompressedBound(PlainRangeBytes(cells), 1);
}

namespace {

// As in the file, before it is packed.
std::string PlainQuantised(const Model& model, const std::vector<Run>& runs)
{
  const std::vector<ParameterGroup> groups = ParameterGroups(model.description);
  if (model.steps.size() != groups.size() ||
      !std::all_of(model.steps.begin(), model.steps.end(), IsStep)) {
    throw Error(ErrorCode::InvalidModel,
                "a quantised model needs a positive step for each of its " +
                    std::to_string(groups.size()) + " matrices and levels");
  }
  const std::size_t count = model.parameters.size();
  std::string plain(count * Planes, '\0');
  ForEachParameter(runs, [&](std::size_t place, std::uint64_t k, std::size_t group) {
    const std::uint16_t code = ZigZag(MultipleOf(model.parameters[k], model.steps[group], k));
    plain[place] = static_cast<char>(code & 0xff);
    plain[count + place] = static_cast<char>(code >> 8);
  });
  return plain;
}

} // namespace

std::string EncodeQuantised(const Model& model, Packing packing)
{
  const std::vector<Run> runs = RunsOf(model.description);
  return PackedReadably(PlainQuantised(model, runs), BoundariesOf(runs), packing);
}

bool IsReadableQuantised(const Model& model)
{
  const std::int64_t bytes = PlainParameterBytes(model.parameters.size());
  if (MayExpand(0, bytes)) {
    return true;
  }
  const std::vector<Run> runs = RunsOf(model.description);
  const std::string packed =
      Compress(PlainQuantised(model, runs), BoundariesOf(runs), Packing::Small);
  return MayExpand(static_cast<std::int64_t>(packed.size()), bytes);
}

AlignedVector<float> DecodeQuantised(const InputFile& file, const Blob& blob, const Model& header,
                                     std::uint32_t& checksum)
{
  const std::uint64_t count = Layout(header.description).parameterCount;
  const auto plain =
      Decompress(Packed(file, blob, checksum), PlainParameterBytes(count), "parameters");
  AlignedVector<float> parameters(count);
  ForEachParameter(
      RunsOf(header.description), [&](std::size_t place, std::uint64_t k, std::size_t group) {
        const auto code = static_cast<std::uint16_t>(plain[place] | plain[count + place] << 8);
        parameters[k] = ValueOfMultiple(FromZigZag(code), header.steps[group]);
      });
  return parameters;
}

std::string EncodeCompactRanges(const std::vector<ValueRange>& ranges, Packing packing)
{
  std::string plain(ranges.size() * 2, '\0');
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const ValueRange& range = ranges[k];
    RequireFiniteRange(range, k);
    plain[k] = static_cast<char>(range.empty() ? 255 : BoundBelow(range.low));
    plain[ranges.size() + k] = static_cast<char>(range.empty() ? 0 : BoundAbove(range.high));
  }
  return PackedReadably(plain, {ranges.size()}, packing);
}

std::vector<ValueRange> DecodeCompactRanges(const InputFile& file, const Blob& blob,
                                            std::int64_t cells, std::uint32_t& checksum)
{
  const auto plain =
      Decompress(Packed(file, blob, checksum), PlainRangeBytes(cells), "macro-cell ranges");
  std::vector<ValueRange> ranges(static_cast<std::size_t>(cells));
  for (std::size_t k = 0; k < ranges.size(); ++k) {
    const std::uint8_t low = plain[k];
    const std::uint8_t high = plain[ranges.size() + k];
    ranges[k] = low > high ? ValueRange{} : ValueRange{Bound(low), Bound(high)};
  }
  return ranges;
}

} // namespace inr
