// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/InferencePrecision.h"

#include "Core/Inference/InferenceKernels.h"
#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

/// With room for what rounding adds in all layers.
constexpr double Largest = std::numeric_limits<float>::max() / 256.0;
/// What is below counts as zero.
constexpr double Smallest = std::numeric_limits<float>::min();
/// What that may come to in a value y.
constexpr double MostLost = 0x1p-30;

double LargestMagnitude(const float* values, std::uint64_t count)
{
  float largest = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    largest = std::max(largest, std::abs(values[k]));
  }
  return largest;
}

/// Of the features: interpolation keeps within those of the corners.
double LargestFeature(const ModelView& model)
{
  double largest = 0;
  for (int l = 0; l < model.levelCount; ++l) {
    const LevelView& level = model.levels[l];
    const std::uint64_t count = std::uint64_t{level.entries} * model.features;
    largest = std::max(largest, LargestMagnitude(model.grid + level.offset, count));
  }
  return largest;
}

/// Of what a layer's rows make of inputs of at most 1.
double LargestSum(const LayerView& layer)
{
  double largest = 0;
  for (std::int64_t row = 0; row < layer.rows; ++row) {
    double sum = 0;
    for (std::int64_t column = 0; column < layer.columns; ++column) {
      sum += std::abs(static_cast<double>(layer.weights[row * layer.columns + column]));
    }
    largest = std::max(largest, sum);
  }
  return largest;
}

/// Of all numbers between two layers.
struct Magnitudes
{
  double largest;
  double lost; ///< by how much one is off at most because others counted as zero
};

/// What a layer's rows make of `in`.
Magnitudes SumsOf(const LayerView& layer, const Magnitudes& in)
{
  const double sum = LargestSum(layer);
  // Inputs, weights, and sums: up to two for each column and product.
  const double lost = sum * (in.lost + Smallest) + layer.columns * Smallest * (in.largest + 6.0);
  return {sum < Largest ? sum * in.largest : sum, lost};
}

Magnitudes Activated(Activation activation, const Magnitudes& sums)
{
  switch (activation) {
  case Activation::Exponential:
    return {std::exp(sums.largest), std::exp(sums.largest) * sums.lost};
  case Activation::Sigmoid:
  case Activation::Sine:
  case Activation::Tanh:
    return {1.0, sums.lost};
  default: // softplus and squareplus are above what they are given by less; slopes are at most 1
    return {sums.largest + 1.0, sums.lost};
  }
}

} // namespace

bool IsUsable(InferencePrecision precision, InstructionSet set)
{
  if (precision == InferencePrecision::Float32) {
    return true;
  }
#ifdef INR_X86_KERNELS
  const bool multiplies =
      set == InstructionSet::Avx512 && IsUsable(set) && __builtin_cpu_supports("avx512bf16");
  return multiplies && (precision == InferencePrecision::BFloat16 || IsTileKernelUsable());
#else
  return false;
#endif
}

bool StaysInRange(const ModelView& model)
{
  Magnitudes at{LargestFeature(model), 0.0};
  for (int l = 0; l < model.layerCount && at.largest < Largest; ++l) {
    at = SumsOf(model.layers[l], at);
    if (at.largest < Largest) {
      const bool last = l + 1 == model.layerCount;
      at = Activated(last ? model.outputActivation : model.activation, at);
    }
  }
  return at.largest < Largest && at.lost <= MostLost;
}

} // namespace inr
