// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>
#include <cstring>
#ifdef __CUDACC__
#include <cuda_fp16.h>
#endif

namespace inr {
namespace cuda {

/// The bits of an IEEE 754 binary16 number.
using HalfBits = std::uint16_t;

/// Those of two, as they lie in memory: the first in the lower bits. May be read and written where
/// halves are.
using PairBits = std::uint32_t __attribute__((may_alias));

constexpr float LargestHalf = 65504.0f;

INR_HOST_DEVICE inline std::uint32_t BitsOf(float value)
{
  std::uint32_t bits;
  memcpy(&bits, &value, sizeof(bits));
  return bits;
}

INR_HOST_DEVICE inline float FloatOf(std::uint32_t bits)
{
  float value;
  memcpy(&value, &bits, sizeof(value));
  return value;
}

/// The nearest half, ties to even; what lies beyond is infinite.
INR_HOST_DEVICE inline HalfBits ToHalf(float value)
{
#ifdef __CUDA_ARCH__
  return __half_as_ushort(__float2half_rn(value));
#else
  const std::uint32_t bits = BitsOf(value);
  const auto sign = static_cast<std::uint32_t>(bits >> 16 & 0x8000u);
  const std::uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) {
    return static_cast<HalfBits>(sign | 0x7e00u);
  }
  if (magnitude >= 0x477ff000u) { // halfway from the largest one to the next would-be
    return static_cast<HalfBits>(sign | 0x7c00u);
  }
  if (magnitude < 0x38800000u) { // denormal: adding 0.5 leaves its last place where a half's is
    const float raised = FloatOf(magnitude) + 0.5f;
    return static_cast<HalfBits>(sign | (BitsOf(raised) - BitsOf(0.5f)));
  }
  const std::uint32_t odd = magnitude >> 13 & 1u;
  const std::uint32_t rounded = magnitude + 0xfffu + odd - ((127u - 15u) << 23);
  return static_cast<HalfBits>(sign | rounded >> 13);
#endif
}

INR_HOST_DEVICE inline float ToFloat(HalfBits half)
{
#ifdef __CUDA_ARCH__
  return __half2float(__ushort_as_half(half));
#else
  const std::uint32_t sign = std::uint32_t{half & 0x8000u} << 16;
  const std::uint32_t magnitude = half & 0x7fffu;
  if (magnitude >= 0x7c00u) {
    return FloatOf(sign | 0x7f800000u | (magnitude & 0x3ffu) << 13);
  }
  if (magnitude < 0x400u) {
    return FloatOf(sign | BitsOf(static_cast<float>(magnitude) * 0x1p-24f));
  }
  return FloatOf(sign | ((magnitude << 13) + ((127u - 15u) << 23)));
#endif
}

/// Two numbers as halves in one word, `low` in its lower bits; what a half cannot hold becomes NaN,
/// and with it every result that depends on it: so that an overflow cannot hide behind an
/// activation that would cut off or bound an infinite number.
INR_HOST_DEVICE inline std::uint32_t PackHalves(float low, float high)
{
#ifdef __CUDA_ARCH__
  const __half2 pair = __floats2half2_rn(low, high);
  const __half2 sticky = __hfma2(pair, __float2half2_rn(0.0f), pair); // infinity * 0 is NaN
  std::uint32_t word;
  memcpy(&word, &sticky, sizeof(word));
  return word;
#else
  const auto sticky = [](float value) {
    const HalfBits half = ToHalf(value);
    return (half & 0x7fffu) == 0x7c00u ? std::uint32_t{0x7fffu} : std::uint32_t{half};
  };
  return sticky(low) | sticky(high) << 16;
#endif
}

/// The same of numbers of which what is below zero becomes zero.
INR_HOST_DEVICE inline std::uint32_t PackRectified(float low, float high)
{
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 800
  const __half2 pair = __floats2half2_rn(low, high);
  const __half2 rectified = __hfma2_relu(pair, __float2half2_rn(0.0f), pair);
  std::uint32_t word;
  memcpy(&word, &rectified, sizeof(word));
  return word;
#else
  const std::uint32_t pair = PackHalves(low, high);
  const auto rectified = [](std::uint32_t half) {
    const bool isNaN = (half & 0x7fffu) > 0x7c00u;
    return (half & 0x8000u) != 0 && !isNaN ? 0u : half;
  };
  return rectified(pair & 0xffffu) | rectified(pair >> 16) << 16;
#endif
}

INR_HOST_DEVICE inline float LowHalf(std::uint32_t pair)
{
  return ToFloat(static_cast<HalfBits>(pair & 0xffffu));
}

INR_HOST_DEVICE inline float HighHalf(std::uint32_t pair)
{
  return ToFloat(static_cast<HalfBits>(pair >> 16));
}

} // namespace cuda
} // namespace inr
