// SPDX-License-Identifier: BSD-3-Clause
//
// The network on a block of encoded samples; see Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Activations.h"
#include "Core/Inference/Mlp.h"
#include "Core/Inference/ModelView.h"

namespace inr {

namespace INR_ISA {

/// Runs `samples` columns (a multiple of LaneCount, at most `stride`) through all layers; returns
/// where the outputs are: in `in` or in `out`, both of stride * model.widest floats.
inline const float* RunNetwork(const ModelView& model, float* in, float* out, std::int64_t stride,
                               std::int64_t samples)
{
  for (int l = 0; l < model.layerCount; ++l) {
    const LayerView& layer = model.layers[l];
    const bool last = l + 1 == model.layerCount;
    MultiplyBlock({layer.weights, layer.rows, layer.columns, layer.columns, 1}, in, stride, samples,
                  out);
    const Activation activation = last ? model.outputActivation : model.activation;
    for (int row = 0; row < layer.rows; ++row) {
      Activate(activation, out + row * stride, samples);
    }
    float* const swap = in;
    in = out;
    out = swap;
  }
  return in;
}

} // namespace INR_ISA
} // namespace inr
