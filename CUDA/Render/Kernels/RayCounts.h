// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// What happened while a ray came further.
struct RayCounts
{
  std::uint32_t rays = 0; ///< 1 where it began, and meets the volume
  std::uint32_t samples = 0;
  std::uint32_t missed = 0;
  std::uint32_t clamped = 0;
  std::uint32_t gradients = 0;
  std::uint32_t scatterings = 0; ///< of paths that ended
  std::uint32_t lightSteps = 0;  ///< samples of these on the way to a light
  std::uint32_t levels = 0;      ///< a bit for each that samples came from

  INR_HOST_DEVICE void add(const RayCounts& part)
  {
    this->rays += part.rays;
    this->samples += part.samples;
    this->missed += part.missed;
    this->clamped += part.clamped;
    this->gradients += part.gradients;
    this->scatterings += part.scatterings;
    this->lightSteps += part.lightSteps;
    this->levels |= part.levels;
  }
};

} // namespace cuda
} // namespace inr
