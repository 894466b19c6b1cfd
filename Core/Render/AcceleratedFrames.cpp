// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/AcceleratedFrames.h"

#include "Core/Error.h"
#include "Core/Image/Metrics.h"

#include <string>

namespace inr {

bool AcceleratedFrames::draws(const Frame& frame) const
{
  return this->Device && !this->Field->failure() && !frame.layers &&
         frame.blending.mode != BlendMode::Isosurface;
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
  this->Steps.reset();
  this->succeeds([&] { this->Device->setColors(majorants, colors); });
}

std::optional<FrameStatistics>
AcceleratedFrames::march(const Frame& frame, const RayGeometry& geometry,
                         const MarchSettings& settings, const ColorLookup& colors,
                         const Shading* shading, const WorkLimit& limit, const PassOutput& output,
                         const std::function<bool()>& keepGoing)
{
  std::optional<FrameStatistics> statistics;
  this->succeeds([&] {
    const double step = settings.step * settings.unitsPerT;
    const int lengths = SampleLengths(this->Device->levels());
    if (!this->Steps || !this->Steps->fits(step, lengths)) {
      this->Steps.emplace(colors, step, lengths);
    }
    statistics = this->Device->march({frame, geometry, settings, *this->Steps, shading}, limit,
                                     output, keepGoing);
  });
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

void AcceleratedFrames::prove(const Image& drawn, const Image& cpu)
{
  constexpr double least = 40; // dB; rounding leaves twice as many
  this->succeeds([&] {
    const double psnr = ImagePsnr(drawn, cpu);
    if (!(psnr >= least)) {
      throw Error(ErrorCode::Device, "it draws a picture that is " + std::to_string(psnr) +
                                         " dB from the CPU's, not the same");
    }
    this->Proven = true;
  });
}

} // namespace inr
