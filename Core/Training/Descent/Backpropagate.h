// SPDX-License-Identifier: BSD-3-Clause
//
// Network forward and back for one block; see Inference/Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Activations.h"
#include "Core/Inference/Mlp.h"
#include "Core/Training/Descent/TrainKernel.h"

namespace inr {
namespace INR_ISA {

/// True when the slope can be told from the activation's result, so that results may overwrite
/// inputs.
inline bool SlopeFromResult(Activation activation)
{
  return activation == Activation::None || activation == Activation::ReLU ||
         activation == Activation::LeakyReLU || activation == Activation::Exponential ||
         activation == Activation::Sigmoid || activation == Activation::Tanh;
}

/// What the forward pass leaves for the backward pass, in one workspace. Rows of TrainRowSize.
struct Activity
{
  const ModelView& model;
  float* encoded;
  float* workspace;

  std::int64_t plane() const { return this->model.widest * TrainRowSize; }
  /// Input of layer l; of layerCount: the output.
  float* input(int layer) const
  {
    return layer == 0 ? this->encoded : this->workspace + (layer - 1) * this->plane();
  }
  /// Layer l's result before its activation.
  float* before(int layer) const
  {
    const bool last = layer + 1 == this->model.layerCount;
    const Activation activation = last ? this->model.outputActivation : this->model.activation;
    return SlopeFromResult(activation)
               ? this->input(layer + 1)
               : this->workspace + (this->model.layerCount + layer) * this->plane();
  }
  float* scratch(int which) const
  {
    return this->workspace + (2 * this->model.layerCount + which) * this->plane();
  }
  static std::int64_t size(const ModelView& model)
  {
    return (2 * model.layerCount + 2) * model.widest * TrainRowSize;
  }
};

inline Activation ActivationOf(const ModelView& model, int layer)
{
  return layer + 1 == model.layerCount ? model.outputActivation : model.activation;
}

/// Columns of a layer that have an input: padding has none, and its weights stay as they are.
inline int UsedColumns(const ModelView& model, int layer)
{
  return layer == 0 ? model.encodedWidth : model.layers[layer].columns;
}

inline void Forward(const ModelView& model, const Activity& activity, std::int64_t samples)
{
  for (int l = 0; l < model.layerCount; ++l) {
    const LayerView& layer = model.layers[l];
    float* before = activity.before(l);
    float* after = activity.input(l + 1);
    MultiplyBlock({layer.weights, layer.rows, UsedColumns(model, l), layer.columns, 1},
                  activity.input(l), TrainRowSize, samples, before);
    for (int row = 0; row < layer.rows; ++row) {
      if (before != after) {
        std::memcpy(after + row * TrainRowSize, before + row * TrainRowSize,
                    static_cast<std::size_t>(samples) * sizeof(float));
      }
      Activate(ActivationOf(model, l), after + row * TrainRowSize, samples);
    }
  }
}

/// delta *= slope of layer l's activation.
inline void ApplySlope(const ModelView& model, const Activity& activity, int layer, float* delta,
                       std::int64_t samples)
{
  const Activation activation = ActivationOf(model, layer);
  if (activation == Activation::None) {
    return;
  }
  const float* before = activity.before(layer);
  const float* after = activity.input(layer + 1);
  for (int row = 0; row < model.layers[layer].rows; ++row) {
    const std::int64_t at = row * TrainRowSize;
    if (activation == Activation::ReLU) {
      for (std::int64_t k = 0; k < samples; k += LaneCount) {
        const Floats kept = Load(after + at + k) > Floats{} ? Load(delta + at + k) : Floats{};
        Store(delta + at + k, kept);
      }
      continue;
    }
    for (std::int64_t k = 0; k < samples; ++k) {
      delta[at + k] *= ActivationSlope(activation, before[at + k], after[at + k]);
    }
  }
}

template <int Rows, int Columns>
inline void OuterTile(const float* delta, const float* input, std::int64_t samples,
                      std::int64_t columns, float* gradient)
{
  Floats sums[Rows][Columns] = {};
  for (std::int64_t k = 0; k < samples; k += LaneCount) {
    Floats in[Columns];
#pragma GCC unroll 4
    for (int c = 0; c < Columns; ++c) {
      in[c] = Load(input + c * TrainRowSize + k);
    }
#pragma GCC unroll 4
    for (int r = 0; r < Rows; ++r) {
      const Floats out = Load(delta + r * TrainRowSize + k);
#pragma GCC unroll 4
      for (int c = 0; c < Columns; ++c) {
        sums[r][c] = MultiplyAdd(out, in[c], sums[r][c]);
      }
    }
  }
  for (int r = 0; r < Rows; ++r) {
    for (int c = 0; c < Columns; ++c) {
      gradient[r * columns + c] += SumLanes(sums[r][c]);
    }
  }
}

/// gradient += delta * input^T over the block's samples.
inline void AddWeightGradient(const LayerView& layer, int usedColumns, const float* delta,
                              const float* input, std::int64_t samples, float* gradient)
{
  for (int row = 0; row < layer.rows;) {
    const bool wholeRows = row + 4 <= layer.rows;
    for (int column = 0; column < usedColumns;) {
      const float* out = delta + row * TrainRowSize;
      const float* in = input + column * TrainRowSize;
      float* target = gradient + row * layer.columns + column;
      const bool wholeColumns = column + 4 <= usedColumns;
      if (wholeRows && wholeColumns) {
        OuterTile<4, 4>(out, in, samples, layer.columns, target);
      } else if (wholeRows) {
        OuterTile<4, 1>(out, in, samples, layer.columns, target);
      } else if (wholeColumns) {
        OuterTile<1, 4>(out, in, samples, layer.columns, target);
      } else {
        OuterTile<1, 1>(out, in, samples, layer.columns, target);
      }
      column += wholeColumns ? 4 : 1;
    }
    row += wholeRows ? 4 : 1;
  }
}

/// d (output - target)^2 / d output, and the sum of the losses. Squares, because PSNR is what a
/// model is judged by.
inline double LossGradient(const TrainBlock& block, const float* output, std::int64_t samples,
                           float* delta)
{
  double loss = 0;
  for (std::int64_t k = 0; k < samples; ++k) {
    const float residual = k < block.count ? output[k] - block.targets[k] : 0.0f;
    // A NaN target carries no gradient; a NaN output makes the loss one, which ends the training.
    const bool known = k < block.count && block.targets[k] == block.targets[k];
    loss += known ? static_cast<double>(residual) * static_cast<double>(residual) : 0.0;
    delta[k] = known ? 2.0f * residual * block.gradientScale : 0.0f;
  }
  return loss;
}

inline void BackpropagateBlock(const ModelView& model, TrainBlock& block, float* workspace)
{
  const Activity activity{model, block.encoded, AlignToLine(workspace)};
  const std::int64_t samples = (block.count + LaneCount - 1) / LaneCount * LaneCount;
  Forward(model, activity, samples);
  float* delta = activity.scratch(0);
  float* next = activity.scratch(1);
  block.loss = LossGradient(block, activity.input(model.layerCount), samples, delta);
  for (int l = model.layerCount - 1; l >= 0; --l) {
    const LayerView& layer = model.layers[l];
    const int usedColumns = UsedColumns(model, l);
    ApplySlope(model, activity, l, delta, samples);
    AddWeightGradient(layer, usedColumns, delta, activity.input(l), samples,
                      block.weightGradient + (layer.weights - model.layers[0].weights));
    float* out = l == 0 ? block.encoded : next;
    MultiplyBlock({layer.weights, usedColumns, layer.rows, 1, layer.columns}, delta, TrainRowSize,
                  samples, out);
    next = delta;
    delta = out;
  }
}

} // namespace INR_ISA
} // namespace inr
