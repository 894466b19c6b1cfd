// SPDX-License-Identifier: BSD-3-Clause
//
// The sums of the network's layers over products of bfloat16 numbers, two of them at a time; see
// Lanes.h for what may be in here. Weights and what goes into a layer are rounded to 8 bits, sums
// are float32. Columns are taken in pairs, always the same ones, and a pair is left out where both
// are zero for the whole strip: in which order a sum comes about does not depend on the strip.
#pragma once

#include "Core/Inference/Activations.h"
#include "Core/Inference/Pairs.h"

namespace inr {
namespace INR_ISA {

/// Makes encoded samples a layer's inputs: row f of `width` is in strip.values from f * StripSize
/// on.
template <int Groups> inline void BeginStrip(int width, Strip& strip)
{
  strip.count = PairRows<Groups>(width, strip);
  for (int k = 0; k < strip.count; ++k) {
    strip.from[k] = k * PanelRows;
  }
}

/// Rows from `row` on, which lie in one panel.
template <int Rows, int Groups>
inline void SumTile(const LayerView& layer, int row, const Strip& in, Floats (&sums)[Rows][Groups])
{
  const std::int64_t panel = row / PanelRows * PanelRows;
  const std::uint32_t* const first =
      layer.pairs + panel * ((layer.columns + 1) / 2) + row % PanelRows;
  SetZero(sums);
  for (int k = 0; k < in.count; ++k) {
    const std::uint32_t* const weights = first + in.from[k];
    __m512i input[Groups];
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      std::memcpy(&input[g], in.values + k * StripSize + g * LaneCount, sizeof(input[g]));
    }
#pragma GCC unroll 8
    for (int r = 0; r < Rows; ++r) {
      const auto weight = (__m512bh)SpreadInt(weights[r]);
#pragma GCC unroll 4
      for (int g = 0; g < Groups; ++g) {
        sums[r][g] = _mm512_dpbf16_ps(sums[r][g], (__m512bh)input[g], weight);
      }
    }
  }
}

/// Appends the rows of a tile, of `rows` of the layer, to `out` in pairs, unless they are zero.
/// Behind the last row there may be one with weights of zero in the next layer.
template <int Rows, int Groups>
inline void AppendPairs(const Floats (&values)[Rows][Groups], int row, int rows, Strip& out)
{
  static_assert(Rows % 2 == 0, "pairs lie within a tile");
#pragma GCC unroll 4
  for (int r = 0; r < Rows; r += 2) {
    if (row + r >= rows) {
      continue;
    }
    float* const to = out.values + out.count * StripSize;
    UInts bits{};
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      const __m512i pair = PairOf(values[r][g], values[r + 1][g]);
      std::memcpy(to + g * LaneCount, &pair, sizeof(pair));
      bits |= (UInts)pair;
    }
    out.from[out.count] = (row + r) / 2 * PanelRows;
    out.count += IsZero(bits) ? 0 : 1;
  }
}

/// The same after an activation.
template <int Rows, int Groups>
inline void AppendTile(Activation activation, const Floats (&sums)[Rows][Groups], int row, int rows,
                       Strip& out)
{
  Floats values[Rows][Groups];
  ActivateTile(activation, sums, values);
  Strip to = out; // stays in registers: for all a compiler knows, a store might change `out`
  AppendPairs(values, row, rows, to);
  out.count = to.count;
}

} // namespace INR_ISA
} // namespace inr
