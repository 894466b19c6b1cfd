// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors of one instruction set. Only for sources that are built once per instruction set (see
// INRInstructionSets.cmake): INR_ISA names the namespace, so that no two builds share a symbol.
// Such sources use no functions of the standard library's templates and no inline functions from
// elsewhere: the linker would keep one copy, and it might be the one this processor cannot run.
#pragma once

#ifdef __FAST_MATH__
#error "Build without -ffast-math and -Ofast: NaN, infinities and the order of sums matter here."
#endif

#include "Core/CacheLine.h"

#include <cstdint>
#include <cstring>
#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace inr {
namespace INR_ISA {

#if defined(__AVX512F__)
constexpr int LaneCount = 16;
#elif defined(__AVX2__)
constexpr int LaneCount = 8;
#else
constexpr int LaneCount = 4;
#endif

using Floats = float __attribute__((vector_size(4 * LaneCount)));
using Ints = std::int32_t __attribute__((vector_size(4 * LaneCount)));
using UInts = std::uint32_t __attribute__((vector_size(4 * LaneCount)));

inline Floats Spread(float value) { return value - Floats{}; }
inline UInts SpreadInt(std::uint32_t value) { return value - UInts{}; }

inline Floats Load(const float* from)
{
  Floats value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

inline void Store(float* to, Floats value) { std::memcpy(to, &value, sizeof(value)); }

/// a*b + c, rounded once where the instruction set can.
inline Floats MultiplyAdd(Floats a, Floats b, Floats c)
{
#if defined(__AVX512F__)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(__FMA__)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}

/// a*b - product, exactly, where `product` is a*b rounded.
inline Floats ProductError(Floats a, Floats b, Floats product)
{
#if defined(__FMA__)
  return MultiplyAdd(a, b, -product);
#else
  Floats error;
  for (int k = 0; k < LaneCount; ++k) { // a product of two floats fits a double
    error[k] = static_cast<float>(static_cast<double>(a[k]) * static_cast<double>(b[k]) -
                                  static_cast<double>(product[k]));
  }
  return error;
#endif
}

/// The larger one; b when either is NaN.
inline Floats Maximum(Floats a, Floats b)
{
#if defined(__AVX512F__)
  return _mm512_maskz_max_ps(0xffff, a, b); // without a mask, GCC 12 warns of its own header
#elif defined(__AVX2__)
  return _mm256_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}

/// The smaller one; b when either is NaN.
inline Floats Minimum(Floats a, Floats b)
{
#if defined(__AVX512F__)
  return _mm512_maskz_min_ps(0xffff, a, b);
#elif defined(__AVX2__)
  return _mm256_min_ps(a, b);
#else
  return a < b ? a : b;
#endif
}

inline Floats SquareRoot(Floats value)
{
#if defined(__AVX512F__)
  return _mm512_maskz_sqrt_ps(0xffff, value);
#elif defined(__AVX2__)
  return _mm256_sqrt_ps(value);
#else
  for (int k = 0; k < LaneCount; ++k) {
    value[k] = __builtin_sqrtf(value[k]);
  }
  return value;
#endif
}

/// True when every bit of `value` is 0.
inline bool IsZero(UInts value)
{
#if defined(__AVX512F__)
  return _mm512_test_epi32_mask((__m512i)value, (__m512i)value) == 0;
#elif defined(__AVX2__)
  return _mm256_testz_si256((__m256i)value, (__m256i)value) != 0;
#else
  std::uint64_t words[sizeof(value) / sizeof(std::uint64_t)];
  std::memcpy(words, &value, sizeof(words));
  return (words[0] | words[1]) == 0;
#endif
}

/// The first place from `memory` on where whole vectors lie within cache lines.
template <class T> inline T* AlignToLine(T* memory)
{
  constexpr std::uintptr_t line = CacheLineBytes;
  const std::uintptr_t past = reinterpret_cast<std::uintptr_t>(memory) % line;
  return reinterpret_cast<T*>(reinterpret_cast<char*>(memory) + (line - past) % line);
}

/// Halves onto halves: a fixed order, the same for every compiler.
inline float SumLanes(Floats value)
{
#if defined(__AVX512F__)
  value +=
      __builtin_shufflevector(value, value, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7);
  value +=
      __builtin_shufflevector(value, value, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11);
  value +=
      __builtin_shufflevector(value, value, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
  value +=
      __builtin_shufflevector(value, value, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
#elif defined(__AVX2__)
  value += __builtin_shufflevector(value, value, 4, 5, 6, 7, 0, 1, 2, 3);
  value += __builtin_shufflevector(value, value, 2, 3, 0, 1, 6, 7, 4, 5);
  value += __builtin_shufflevector(value, value, 1, 0, 3, 2, 5, 4, 7, 6);
#else
  value += __builtin_shufflevector(value, value, 2, 3, 0, 1);
  value += __builtin_shufflevector(value, value, 1, 0, 3, 2);
#endif
  return value[0];
}

} // namespace INR_ISA
} // namespace inr
