// SPDX-License-Identifier: BSD-3-Clause
//
// A model in float32 for one sample by one thread, whatever its size.
#pragma once

#include "CUDA/Inference/Kernels/Activate.h"
#include "CUDA/Inference/Kernels/Encode.h"

namespace inr {
namespace cuda {

struct FloatModel
{
  GridView<float> grid;
  const LayerView* layers; ///< with row-major weights
  int layerCount;
  Activation activation;
  Activation outputActivation;
  int widest; ///< largest number of rows or columns of any layer
};

/// Inputs and outputs of a layer, for the calling thread: number k of neighbouring threads lie side
/// by side.
class ThreadScratch
{
public:
  /// `memory`: 2 * widest floats for every thread of the grid.
  template <class Block>
  INR_HOST_DEVICE ThreadScratch(const FloatModel& model, float* memory, const Block& block,
                                int thread, int threadsPerBlock)
      : Threads(std::int64_t{block.count()} * threadsPerBlock),
        Index(std::int64_t{block.index()} * threadsPerBlock + thread), Widest(model.widest),
        Memory(memory)
  {}

  INR_HOST_DEVICE std::int64_t index() const { return this->Index; } ///< of the thread in the grid
  INR_HOST_DEVICE std::int64_t threads() const { return this->Threads; }

  /// Number k of side 0 or 1.
  INR_HOST_DEVICE float& at(int side, int k) const
  {
    return this->Memory[(std::int64_t{side} * this->Widest + k) * this->Threads + this->Index];
  }

private:
  std::int64_t Threads;
  std::int64_t Index;
  int Widest;
  float* Memory;
};

INR_HOST_DEVICE inline void EncodeFloat(const FloatModel& model, const Point& point,
                                        const ThreadScratch& scratch)
{
  WithFeatures(model.grid.features, [&](auto features) {
    constexpr int count = decltype(features)::value;
    for (int l = 0; l < model.grid.levelCount; ++l) {
      float sums[count];
      InterpolateAt(model.grid, model.grid.levels[l], point, sums);
      for (int f = 0; f < count; ++f) {
        scratch.at(0, l * count + f) = sums[f];
      }
    }
  });
}

/// Output at a point of the unit cube; NaN where a number left float's range on its way.
INR_HOST_DEVICE inline float EvaluateFloat(const FloatModel& model, const Point& point,
                                           const ThreadScratch& scratch)
{
  EncodeFloat(model, point, scratch);
  int columns = model.grid.levelCount * model.grid.features; // the padding's inputs are zero
  for (int l = 0; l < model.layerCount; ++l) {
    const LayerView& layer = model.layers[l];
    const bool last = l + 1 == model.layerCount;
    for (int row = 0; row < layer.rows; ++row) {
      const float* const weights = layer.weights + std::int64_t{row} * layer.columns;
      float sum = 0.0f;
      for (int column = 0; column < columns; ++column) {
        sum = fmaf(weights[column], scratch.at(l % 2, column), sum);
      }
      scratch.at((l + 1) % 2, row) =
          Sticky(Activate(last ? model.outputActivation : model.activation, Sticky(sum)));
    }
    columns = layer.rows;
  }
  return scratch.at(model.layerCount % 2, 0);
}

} // namespace cuda
} // namespace inr
