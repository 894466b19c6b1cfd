// SPDX-License-Identifier: BSD-3-Clause
//
// Changes of numbers that many threads of a launch share; on the host threads take turns, so that
// ordinary ones do. All return what was there before. Only of integers: sums of floats would depend
// on the order.
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {
namespace cuda {

INR_HOST_DEVICE inline std::uint32_t AtomicAdd(std::uint32_t& sum, std::uint32_t summand)
{
#ifdef __CUDA_ARCH__
  return atomicAdd(&sum, summand);
#else
  const std::uint32_t before = sum;
  sum += summand;
  return before;
#endif
}

INR_HOST_DEVICE inline std::uint64_t AtomicAdd(std::uint64_t& sum, std::uint64_t summand)
{
#ifdef __CUDA_ARCH__
  static_assert(sizeof(unsigned long long) == sizeof(std::uint64_t));
  return atomicAdd(reinterpret_cast<unsigned long long*>(&sum), summand);
#else
  const std::uint64_t before = sum;
  sum += summand;
  return before;
#endif
}

INR_HOST_DEVICE inline std::uint32_t AtomicMax(std::uint32_t& largest, std::uint32_t number)
{
#ifdef __CUDA_ARCH__
  return atomicMax(&largest, number);
#else
  const std::uint32_t before = largest;
  largest = before < number ? number : before;
  return before;
#endif
}

INR_HOST_DEVICE inline std::uint32_t AtomicOr(std::uint32_t& bits, std::uint32_t more)
{
#ifdef __CUDA_ARCH__
  return atomicOr(&bits, more);
#else
  const std::uint32_t before = bits;
  bits |= more;
  return before;
#endif
}

/// AtomicAdd to the same sum by all threads that are here: of a warp's, one adds for those that are
/// here at once. They get places one after another.
INR_HOST_DEVICE inline std::uint64_t AtomicAddTogether(std::uint64_t& sum, std::uint32_t summand)
{
#ifdef __CUDA_ARCH__
  const unsigned active = __activemask();
  const int lane = static_cast<int>(threadIdx.x % 32);
  std::uint32_t before = 0;
  std::uint32_t total = 0;
  for (unsigned rest = active; rest != 0; rest &= rest - 1) {
    const int other = __ffs(static_cast<int>(rest)) - 1;
    const std::uint32_t part = __shfl_sync(active, summand, other);
    before += other < lane ? part : 0;
    total += part;
  }
  const int first = __ffs(static_cast<int>(active)) - 1;
  std::uint64_t begin = 0;
  if (lane == first) {
    begin = AtomicAdd(sum, std::uint64_t{total});
  }
  return __shfl_sync(active, begin, first) + before;
#else
  return AtomicAdd(sum, std::uint64_t{summand});
#endif
}

/// Puts `wanted` where `expected` is.
INR_HOST_DEVICE inline std::uint64_t AtomicExchangeIf(std::uint64_t& place, std::uint64_t expected,
                                                      std::uint64_t wanted)
{
#ifdef __CUDA_ARCH__
  return atomicCAS(reinterpret_cast<unsigned long long*>(&place), expected, wanted);
#else
  const std::uint64_t before = place;
  place = before == expected ? wanted : before;
  return before;
#endif
}

} // namespace cuda
} // namespace inr
