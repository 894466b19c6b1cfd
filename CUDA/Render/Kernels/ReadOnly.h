// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/vec4.hpp>

namespace inr {
namespace cuda {

/// A number in the device's memory that nobody writes as long as the kernel runs: such reads may
/// go on beside whatever else it does.
template <class Number> INR_HOST_DEVICE inline Number ReadOnly(const Number* place)
{
#ifdef __CUDA_ARCH__
  return __ldg(place);
#else
  return *place;
#endif
}

/// Four at once; they are aligned as one.
INR_HOST_DEVICE inline glm::vec4 ReadOnlyFour(const float* place)
{
#ifdef __CUDA_ARCH__
  const float4 four = __ldg(reinterpret_cast<const float4*>(place));
  return {four.x, four.y, four.z, four.w};
#else
  return {place[0], place[1], place[2], place[3]};
#endif
}

} // namespace cuda
} // namespace inr
