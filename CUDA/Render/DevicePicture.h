// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/FrameCounts.h"
#include "CUDA/Render/Kernels/RenderScene.h"
#include "Core/Render/Scene/Frame.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <algorithm>
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
    if (!this->Staged || Channels * pixels > this->Staged->size()) { // which takes long
      this->Values.reset();
      this->Staged.reset();
      this->Values.emplace(this->Where.template allocate<float>(Channels * pixels));
      this->Staged.emplace(this->Where.template allocatePinned<float>(Channels * pixels));
    }
    this->Pixels = pixels;
  }
  PictureView view() const
  {
    float* const rgba = this->Values->data();
    return {rgba, rgba + DepthAt * this->Pixels, rgba + SamplesAt * this->Pixels};
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

  /// To images of the picture's size, `depth` and `samples` of which may be null. By memory that
  /// the machine copies to by itself: into any other it goes page by page, and waits each time.
  void copyTo(float* rgba, float* depth, float* samples) const
  {
    const int channels = samples != nullptr ? Channels : depth != nullptr ? SamplesAt : DepthAt;
    const float* const staged = this->Staged->data();
    this->Where.toHost(this->Staged->data(), this->Values->data(), channels * this->Pixels);
    std::copy_n(staged, DepthAt * this->Pixels, rgba);
    if (depth != nullptr) {
      std::copy_n(staged + DepthAt * this->Pixels, this->Pixels, depth);
    }
    if (samples != nullptr) {
      std::copy_n(staged + SamplesAt * this->Pixels, 2 * this->Pixels, samples);
    }
  }

  /// From images of the picture's size, `depth` of which may be null.
  void copyFrom(const float* rgba, const float* depth)
  {
    this->Where.toMachine(this->Values->data(), rgba, DepthAt * this->Pixels);
    if (depth != nullptr) {
      this->Where.toMachine(this->Values->data() + DepthAt * this->Pixels, depth, this->Pixels);
    }
  }

private:
  /// Of all pixels RGBA, then their depths, then two channels of samples.
  static constexpr int DepthAt = 4;
  static constexpr int SamplesAt = 5;
  static constexpr int Channels = 7;

  using Floats = typename Machine::template Array<float>;

  Machine& Where;
  typename Machine::template Array<FrameCounts> Counts;
  std::optional<Floats> Values;
  std::optional<Floats> Staged; ///< on the host
  std::int64_t Pixels = 0;
};

} // namespace cuda
} // namespace inr
