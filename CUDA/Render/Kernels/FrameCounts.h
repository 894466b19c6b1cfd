// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "CUDA/Render/Kernels/RayMarch.h"

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
  static constexpr int MostLevels = 32;
  std::uint64_t levels[MostLevels]; ///< samples, or more, of rays that met each

  INR_HOST_DEVICE void add(const RayCounts& ray)
  {
    Add(this->rays, ray.rays);
    Add(this->samples, ray.samples);
    Add(this->missed, ray.missed);
    Add(this->clamped, ray.clamped);
    Add(this->gradients, ray.gradients);
    Add(this->scatterings, ray.scatterings);
    Add(this->lightSteps, ray.lightSteps);
    for (int level = 0; level < MostLevels; ++level) {
      Add(this->levels[level], ray.levels >> level & 1u);
    }
  }

private:
  /// One of a warp's threads adds for all that are here.
  INR_HOST_DEVICE static void Add(std::uint64_t& sum, std::uint32_t summand)
  {
#ifdef __CUDA_ARCH__
    const unsigned active = __activemask();
    std::uint64_t total = 0;
    for (unsigned rest = active; rest != 0; rest &= rest - 1) {
      total += __shfl_sync(active, summand, __ffs(static_cast<int>(rest)) - 1);
    }
    const unsigned lane = threadIdx.x % 32;
    if (total > 0 && static_cast<unsigned>(__ffs(static_cast<int>(active))) == lane + 1) {
      AtomicAdd(sum, total);
    }
#else
    sum += summand;
#endif
  }
};

} // namespace cuda
} // namespace inr
