// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/AcceleratedFrames.h"

#include "Core/Error.h"
#include "Core/Image/Metrics.h"

#include <algorithm>
#include <string>

namespace inr {

namespace {

/// A bit for each kind of picture that kernels make in a way of their own.
std::uint32_t KindOf(const Frame& frame)
{
  const auto mode = static_cast<unsigned>(frame.blending.mode);
  const unsigned lit = frame.shading ? 1 : 0;
  const unsigned cropped = frame.cropping ? 1 : 0;
  return 1u << (4 * mode + 2 * lit + cropped);
}

bool ShowsSomething(const Image& rgba)
{
  for (std::size_t k = 3; k < rgba.pixels.size(); k += 4) {
    if (rgba.pixels[k] > 0.0f) {
      return true;
    }
  }
  return false;
}

} // namespace

bool AcceleratedFrames::draws(const Frame& frame)
{
  if (this->Device && this->Field->failure()) { // of which somebody else was told
    this->Device.reset();
  }
  return this->Device && !frame.layers && frame.blending.mode != BlendMode::Isosurface;
}

bool AcceleratedFrames::succeeds(const std::function<void()>& call)
{
  if (!this->Device) {
    return false;
  }
  try {
    call();
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Device) {
      throw;
    }
    this->Field->fail(error, true);
    this->Device.reset();
    return false;
  }
}

void AcceleratedFrames::setColors(const Majorants& majorants, const ColorLookup& colors)
{
  this->succeeds([&] { this->Device->setColors(majorants, colors); });
}

std::optional<FrameStatistics> AcceleratedFrames::march(const MarchJob& job, const WorkLimit& limit,
                                                        const PassOutput& output,
                                                        const std::function<bool()>& keepGoing)
{
  std::optional<FrameStatistics> statistics;
  this->succeeds([&] { statistics = this->Device->march(job, limit, output, keepGoing); });
  return statistics;
}

std::optional<TracedTiles> AcceleratedFrames::tracePaths(const PathRound& round,
                                                         const WorkLimit& limit,
                                                         const std::function<bool()>& keepGoing)
{
  std::optional<TracedTiles> traced;
  this->succeeds([&] { traced = this->Device->tracePaths(round, limit, keepGoing); });
  return traced;
}

void AcceleratedFrames::prove(const Frame& frame, double scale, const March& accelerated,
                              const March& cpu)
{
  constexpr double least = 40; // dB; rounding leaves twice as many
  constexpr int edge = 24;     // pixels: little has to be inferred for them
  const std::uint32_t kind = KindOf(frame);
  if ((this->Proven & kind) != 0 || !this->draws(frame)) {
    return;
  }
  Frame small = frame;
  small.mode = RenderMode::RayMarching;
  small.width = small.height = edge;
  small.opaqueDepth = nullptr;
  small.timeLimit = 0;
  small.levelOfDetailScale = std::max(frame.levelOfDetailScale, scale);
  small.errorTolerance.reset();
  Image drawn(edge, edge, 4);
  accelerated(small, {drawn, nullptr});
  if (!this->draws(frame)) { // it has failed
    return;
  }
  Image truth(edge, edge, 4);
  cpu(small, {truth, nullptr});
  this->succeeds([&] {
    const double psnr = ImagePsnr(drawn, truth);
    if (!(psnr >= least)) {
      throw Error(ErrorCode::Device, "it draws a picture that is " + std::to_string(psnr) +
                                         " dB from the CPU's, not the same");
    }
    if (ShowsSomething(truth)) { // else it proves nothing
      this->Proven |= kind;
    }
  });
}

} // namespace inr
