// SPDX-License-Identifier: BSD-3-Clause
//
// The sums of the network's layers in float32; see Lanes.h for what may be in here. What an
// activation makes zero for the whole strip is left out of the next layer: with ReLU that is more
// than half of a trained network, because samples that lie together use the same neurons. Leaving
// out a product with zero changes no sum, so that a sample's value does not depend on its strip.
#pragma once

#include "Core/Inference/Activations.h"
#include "Core/Inference/Strip.h"

namespace inr {
namespace INR_ISA {

/// Makes encoded samples a layer's inputs: row f of `width` is in strip.values from f * StripSize
/// on.
template <int Groups> inline void BeginStrip(int width, Strip& strip)
{
  strip.count = width; // the padding is zero
  for (int k = 0; k < width; ++k) {
    strip.from[k] = k * PanelRows;
  }
}

/// Rows from `row` on, which lie in one panel.
template <int Rows, int Groups>
inline void SumTile(const LayerView& layer, int row, const Strip& in, Floats (&sums)[Rows][Groups])
{
  const std::int64_t panel = row / PanelRows * PanelRows;
  const float* const first = layer.panels + panel * layer.columns + row % PanelRows;
  SetZero(sums);
  for (int k = 0; k < in.count; ++k) {
    const float* const weights = first + in.from[k];
    Floats input[Groups];
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      input[g] = Load(in.values + k * StripSize + g * LaneCount);
    }
#pragma GCC unroll 8
    for (int r = 0; r < Rows; ++r) {
      const Floats weight = Spread(weights[r]);
#pragma GCC unroll 4
      for (int g = 0; g < Groups; ++g) {
        sums[r][g] = MultiplyAdd(weight, input[g], sums[r][g]);
      }
    }
  }
}

/// Appends a row of inputs to `out`, unless it is zero.
template <int Groups> inline void AppendRow(const Floats (&values)[Groups], int row, Strip& out)
{
  float* const to = out.values + out.count * StripSize;
  UInts bits{};
#pragma GCC unroll 4
  for (int g = 0; g < Groups; ++g) {
    Store(to + g * LaneCount, values[g]);
    bits |= (UInts)values[g];
  }
  out.from[out.count] = row * PanelRows;
  out.count += IsZero(bits) ? 0 : 1;
}

/// The same with all rows of a tile, of `rows` of the layer, after an activation.
template <int Rows, int Groups>
inline void AppendTile(Activation activation, const Floats (&sums)[Rows][Groups], int row, int rows,
                       Strip& out)
{
  Floats values[Rows][Groups];
  ActivateTile(activation, sums, values);
  Strip to = out; // stays in registers: for all a compiler knows, a store might change `out`
#pragma GCC unroll 8
  for (int r = 0; r < Rows; ++r) {
    if (row + r < rows) {
      AppendRow<Groups>(values[r], row + r, to);
    }
  }
  out.count = to.count;
}

} // namespace INR_ISA
} // namespace inr
