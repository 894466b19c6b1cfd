// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/FrameCounts.h"
#include "Core/Render/Frame.h"

#include <cstdint>
#include <optional>

namespace inr {
namespace cuda {

/// Where a machine's kernels put the pixels of a picture, and what they count.
template <class Machine> class DevicePicture
{
public:
  explicit DevicePicture(Machine& machine)
      : Where(machine), Counts(machine.template allocate<FrameCounts>(1))
  {}

  /// For pictures of so many pixels; what was in it is gone where that is another number.
  void resize(std::int64_t pixels)
  {
    if (!this->Rgba || pixels != this->Pixels) {
      this->Pixels = 0; // should memory run out
      this->Rgba.reset();
      this->Depth.reset();
      this->Samples.reset();
      this->Rgba.emplace(this->Where.template allocate<float>(4 * pixels));
      this->Depth.emplace(this->Where.template allocate<float>(pixels));
      this->Samples.emplace(this->Where.template allocate<float>(2 * pixels));
      this->Pixels = pixels;
    }
  }
  PictureView view() const
  {
    return {this->Rgba->data(), this->Depth->data(), this->Samples->data()};
  }
  FrameCounts* counts() const { return this->Counts.data(); }

  void clearCounts() { this->Where.fill(this->Counts.data(), 0, 1); }
  /// Waits for all that was begun.
  FrameStatistics statistics() const
  {
    FrameCounts counts{};
    this->Where.toHost(&counts, this->Counts.data(), 1);
    FrameStatistics statistics;
    statistics.accelerated = true;
    statistics.rays = static_cast<std::int64_t>(counts.rays);
    statistics.samples = static_cast<std::int64_t>(counts.samples);
    statistics.missed = static_cast<std::int64_t>(counts.missed);
    statistics.clamped = static_cast<std::int64_t>(counts.clamped);
    statistics.work.gradients = static_cast<std::int64_t>(counts.gradients);
    statistics.work.scatterings = static_cast<std::int64_t>(counts.scatterings);
    statistics.work.lightSteps = static_cast<std::int64_t>(counts.lightSteps);
    for (int level = 0; level < 32; ++level) {
      if ((counts.levels >> level & 1u) != 0) {
        statistics.levels.add({level, level});
      }
    }
    return statistics;
  }

  /// To images of the picture's size, `depth` and `samples` of which may be null.
  void copyTo(float* rgba, float* depth, float* samples) const
  {
    this->Where.toHost(rgba, this->Rgba->data(), 4 * this->Pixels);
    if (depth != nullptr) {
      this->Where.toHost(depth, this->Depth->data(), this->Pixels);
    }
    if (samples != nullptr) {
      this->Where.toHost(samples, this->Samples->data(), 2 * this->Pixels);
    }
  }

private:
  using Floats = typename Machine::template Array<float>;

  Machine& Where;
  typename Machine::template Array<FrameCounts> Counts;
  std::optional<Floats> Rgba;
  std::optional<Floats> Depth;
  std::optional<Floats> Samples;
  std::int64_t Pixels = 0;
};

} // namespace cuda
} // namespace inr
