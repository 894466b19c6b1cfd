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
