// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "CUDA/Render/Kernels/RayCounts.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// What FrameStatistics tells of a picture, summed up by all threads.
struct FrameCounts
{
  std::uint64_t rays;
  std::uint64_t samples;
  std::uint64_t missed;
  std::uint64_t clamped;
  std::uint64_t gradients;
  std::uint64_t scatterings;
  std::uint64_t lightSteps;
  std::uint32_t levels; ///< a bit for each that samples came from

  INR_HOST_DEVICE void add(const RayCounts& ray)
  {
    Add(this->rays, ray.rays);
    Add(this->samples, ray.samples);
    Add(this->missed, ray.missed);
    Add(this->clamped, ray.clamped);
    Add(this->gradients, ray.gradients);
    Add(this->scatterings, ray.scatterings);
    Add(this->lightSteps, ray.lightSteps);
    if ((ray.levels & ~this->levels) != 0) { // hardly ever: all meet the same few
      AtomicOr(this->levels, ray.levels);
    }
  }

private:
  /// Most of them are zero for all threads of a warp.
  INR_HOST_DEVICE static void Add(std::uint64_t& sum, std::uint32_t summand)
  {
    if (summand > 0) {
      AtomicAddTogether(sum, summand);
    }
  }
};

} // namespace cuda
} // namespace inr
