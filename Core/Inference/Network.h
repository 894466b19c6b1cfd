// SPDX-License-Identifier: BSD-3-Clause
//
// The network on a strip of encoded samples; see Lanes.h for what may be in here.
#pragma once

#if defined(INR_TILES)
#include "Core/Inference/TileSums.h"
#elif defined(INR_BFLOAT16)
#include "Core/Inference/BFloat16Sums.h"
#else
#include "Core/Inference/FloatSums.h"
#endif

namespace inr {

namespace INR_ISA {

#ifndef INR_TILES

/// Lives as long as RunStrip is called: nothing has to be set up.
struct Batch
{
  Batch() {} // written out, so that a variable of it does not count as unused
};

inline void ActivateAll(Activation activation, float* values, std::int64_t count)
{
  Activate(activation, values, count);
}

/// The first row.
template <int Groups>
inline void SumRow(const LayerView& layer, const Strip& in, Floats (&sums)[Groups])
{
  Floats rows[1][Groups];
  SumTile<1, Groups>(layer, 0, in, rows);
  for (int g = 0; g < Groups; ++g) {
    sums[g] = rows[0][g];
  }
}

#endif

/// The hidden layers; returns what goes into the last one: one of `in` and `out`.
template <int Groups, class Between>
inline const Strip& RunHiddenLayers(const ModelView& model, Strip& in, Strip& out, Between& between)
{
  for (int l = 0; l + 1 < model.layerCount; ++l) {
    const LayerView& layer = model.layers[l];
    Strip& from = l % 2 == 0 ? in : out;
    Strip& to = l % 2 == 0 ? out : in;
    to.count = 0;
    for (int row = 0; row < layer.rows; row += StripRows) {
      Floats sums[StripRows][Groups];
      SumTile<StripRows, Groups>(layer, row, from, sums);
      AppendTile<StripRows, Groups>(model.activation, sums, row, layer.rows, to);
      between();
    }
  }
  return model.layerCount % 2 == 1 ? in : out;
}

template <int Groups, class Between>
inline void RunGroups(const ModelView& model, Strip& in, Strip& out, float* y, Between& between)
{
  BeginStrip<Groups>(model.encodedWidth, in);
  const Strip& last = RunHiddenLayers<Groups>(model, in, out, between);
  Floats sums[Groups];
  SumRow<Groups>(model.layers[model.layerCount - 1], last, sums);
  for (int g = 0; g < Groups; ++g) {
    Store(y + g * LaneCount, sums[g]);
  }
  ActivateAll(model.outputActivation, y, Groups * LaneCount);
}

inline int HiddenTiles(const ModelView& model)
{
  int tiles = 0;
  for (int l = 0; l + 1 < model.layerCount; ++l) {
    tiles += (model.layers[l].rows + StripRows - 1) / StripRows;
  }
  return tiles;
}

/// Outputs of the first `samples` (1 to StripSize) of a strip, whose encoding is in
/// strips.in.values: row f of model.encodedWidth from f * StripSize on. Writes LaneCount values at
/// a time to `y`. There must be a Batch. Calls between() HiddenTiles(model) times, as evenly spread
/// as may be.
template <class Between>
inline void RunStrip(const ModelView& model, StripPair& strips, int samples, float* y,
                     Between& between)
{
  if (samples <= LaneCount) {
    RunGroups<1>(model, strips.in, strips.out, y, between);
  } else if (StripGroups == 2 || samples <= 2 * LaneCount) {
    RunGroups<2>(model, strips.in, strips.out, y, between);
  } else if (StripGroups == 3 || samples <= 3 * LaneCount) {
    RunGroups<3>(model, strips.in, strips.out, y, between);
  } else {
    RunGroups<StripGroups>(model, strips.in, strips.out, y, between);
  }
}

} // namespace INR_ISA
} // namespace inr
