// SPDX-License-Identifier: BSD-3-Clause
//
// The network on a strip of encoded samples; see Lanes.h for what may be in here. A strip is as
// wide as a tile of results that stays in registers, and all its layers stay in the first-level
// cache. What an activation makes zero for the whole strip is left out of the next layer: with ReLU
// that is more than half of a trained network, because samples that lie together use the same
// neurons. Leaving out a product with zero changes no sum, so that a sample's value does not depend
// on its strip.
#pragma once

#include "Core/Inference/Activations.h"
#include "Core/Inference/ModelView.h"

namespace inr {

namespace INR_ISA {

/// Registers hold a tile of results: rows of a layer by groups of LaneCount samples.
constexpr int StripRows = LaneCount == 16 ? PanelRows : 4;
constexpr int StripGroups = LaneCount == 8 ? 3 : 2; // see RunStrip
constexpr int StripSize = StripGroups * LaneCount;
static_assert(PanelRows % StripRows == 0, "a tile lies within a panel");

/// Inputs of a layer: those columns that are not zero for all samples.
struct Strip
{
  float* values;      ///< of the k-th such column: from k * StripSize on
  std::int32_t* from; ///< where its weights begin in a panel, in floats
  int count;
};

template <int Rows, int Groups>
inline void SumTile(const float* panel, const Strip& in, Floats (&sums)[Rows][Groups])
{
#pragma GCC unroll 8
  for (int r = 0; r < Rows; ++r) {
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      sums[r][g] = Floats{};
    }
  }
  for (int k = 0; k < in.count; ++k) {
    const float* const weights = panel + in.from[k];
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

/// Activates one row of results and appends it to `out`, unless it is zero.
template <int Groups>
inline void AppendRow(Activation activation, const Floats (&sums)[Groups], int row, Strip& out)
{
  float* const values = out.values + out.count * StripSize;
  UInts bits{};
#pragma GCC unroll 4
  for (int g = 0; g < Groups; ++g) {
    // A NaN stays one.
    const Floats kept = activation == Activation::ReLU ? Maximum(Floats{}, sums[g]) : sums[g];
    Store(values + g * LaneCount, kept);
    bits |= (UInts)kept;
  }
  bool zero = IsZero(bits);
  if (activation != Activation::ReLU && activation != Activation::None) {
    Activate(activation, values, Groups * LaneCount);
    zero = false;
  }
  out.from[out.count] = row * PanelRows;
  out.count += zero ? 0 : 1;
}

template <int Rows, int Groups>
inline void RunTile(const LayerView& layer, Activation activation, int row, const Strip& in,
                    Strip& out)
{
  const std::int64_t panel = row / PanelRows * PanelRows;
  Floats sums[Rows][Groups];
  SumTile<Rows, Groups>(layer.panels + panel * layer.columns + row % PanelRows, in, sums);
#pragma GCC unroll 8
  for (int r = 0; r < Rows; ++r) {
    if (row + r < layer.rows) {
      AppendRow<Groups>(activation, sums[r], row + r, out);
    }
  }
}

/// The hidden layers; returns what goes into the last one: one of `in` and `out`.
template <int Groups, class Between>
inline const Strip& RunHiddenLayers(const ModelView& model, Strip& in, Strip& out, Between& between)
{
  for (int l = 0; l + 1 < model.layerCount; ++l) {
    Strip& from = l % 2 == 0 ? in : out;
    Strip& to = l % 2 == 0 ? out : in;
    to.count = 0;
    for (int row = 0; row < model.layers[l].rows; row += StripRows) {
      RunTile<StripRows, Groups>(model.layers[l], model.activation, row, from, to);
      between();
    }
  }
  return model.layerCount % 2 == 1 ? in : out;
}

template <int Groups, class Between>
inline void RunGroups(const ModelView& model, Strip& in, Strip& out, float* y, Between& between)
{
  const Strip& last = RunHiddenLayers<Groups>(model, in, out, between);
  Floats sums[1][Groups];
  SumTile<1, Groups>(model.layers[model.layerCount - 1].panels, last, sums);
  for (int g = 0; g < Groups; ++g) {
    Store(y + g * LaneCount, sums[0][g]);
  }
  Activate(model.outputActivation, y, Groups * LaneCount);
}

inline int HiddenTiles(const ModelView& model)
{
  int tiles = 0;
  for (int l = 0; l + 1 < model.layerCount; ++l) {
    tiles += (model.layers[l].rows + StripRows - 1) / StripRows;
  }
  return tiles;
}

/// Scratch memory for strips, in floats.
inline std::int64_t StripWorkspace(const ModelView& model)
{
  return 2 * model.widest * (StripSize + 1) + 64;
}

/// A strip's memory: `in` is to be filled with encoded samples, out is scratch.
struct StripPair
{
  Strip in;
  Strip out;
};

inline StripPair MakeStrips(const ModelView& model, float* workspace)
{
  float* const values = AlignToLine(workspace);
  const std::int64_t size = static_cast<std::int64_t>(model.widest) * StripSize;
  auto* const from = reinterpret_cast<std::int32_t*>(values + 2 * size);
  return {{values, from, 0}, {values + size, from + model.widest, 0}};
}

/// Outputs of the first `samples` (1 to StripSize) of a strip, whose encoding is in
/// strips.in.values: row f of model.encodedWidth from f * StripSize on. Writes LaneCount values at
/// a time to `y`. Calls between() HiddenTiles(model) times, as evenly spread as may be.
template <class Between>
inline void RunStrip(const ModelView& model, StripPair& strips, int samples, float* y,
                     Between& between)
{
  strips.in.count = model.encodedWidth; // the padding is zero
  for (int k = 0; k < model.encodedWidth; ++k) {
    strips.in.from[k] = k * PanelRows;
  }
  if (samples <= LaneCount) {
    RunGroups<1>(model, strips.in, strips.out, y, between);
  } else if (StripGroups == 2 || samples <= 2 * LaneCount) {
    RunGroups<2>(model, strips.in, strips.out, y, between);
  } else {
    RunGroups<StripGroups>(model, strips.in, strips.out, y, between);
  }
}

} // namespace INR_ISA
} // namespace inr
