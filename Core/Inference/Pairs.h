// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of bfloat16 numbers; see Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Strip.h"

namespace inr {
namespace INR_ISA {

/// The numbers of two columns, rounded to nearest: those of `first` in the lower halves of lanes.
inline __m512i PairOf(Floats first, Floats second)
{
  const __m512i order = _mm512_set_epi16(31, 15, 30, 14, 29, 13, 28, 12, 27, 11, 26, 10, 25, 9, 24,
                                         8, 23, 7, 22, 6, 21, 5, 20, 4, 19, 3, 18, 2, 17, 1, 16, 0);
  return _mm512_permutexvar_epi16(order, (__m512i)_mm512_cvtne2ps_pbh(second, first));
}

/// Makes pairs of `width` rows, of which row f is in strip.values from f * StripSize on: pair k
/// will be from k * StripSize on, before or where its rows are. Returns how many.
template <int Groups> inline int PairRows(int width, Strip& strip)
{
  const int pairs = (width + 1) / 2;
  for (int k = 0; k < pairs; ++k) {
    const float* const first = strip.values + 2 * k * StripSize;
    const bool isWhole = 2 * k + 1 < width; // the padding is zero
    for (int at = 0; at < Groups * LaneCount; at += LaneCount) {
      const Floats second = isWhole ? Load(first + StripSize + at) : Floats{};
      const __m512i pair = PairOf(Load(first + at), second);
      std::memcpy(strip.values + k * StripSize + at, &pair, sizeof(pair));
    }
  }
  return pairs;
}

} // namespace INR_ISA
} // namespace inr
