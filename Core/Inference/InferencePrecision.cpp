// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/InferencePrecision.h"

#include "Core/Inference/InstructionSet.h"
#include "Core/Inference/ModelView.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

/// With room for what rounding adds in all layers.
constexpr double Largest = std::numeric_limits<float>::max() / 256.0;

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

double LargestActivation(Activation activation, double largest)
{
  switch (activation) {
  case Activation::Exponential:
    return std::exp(largest);
  case Activation::Sigmoid:
  case Activation::Sine:
  case Activation::Tanh:
    return 1.0;
  default:
    return largest + 1.0; // softplus and squareplus are above what they are given by less
  }
}

} // namespace

bool IsUsable(InferencePrecision precision, InstructionSet set)
{
  if (precision == InferencePrecision::Float32) {
    return true;
  }
#ifdef INR_X86_KERNELS
  return set == InstructionSet::Avx512 && IsUsable(set) && __builtin_cpu_supports("avx512bf16");
#else
  return false;
#endif
}

bool StaysInRange(const ModelView& model)
{
  double largest = LargestFeature(model);
  for (int l = 0; l < model.layerCount && largest < Largest; ++l) {
    const double sum = LargestSum(model.layers[l]);
    const bool last = l + 1 == model.layerCount;
    largest = sum < Largest ? sum * largest : sum;
    if (largest < Largest) {
      largest = LargestActivation(last ? model.outputActivation : model.activation, largest);
    }
  }
  return largest < Largest;
}

} // namespace inr
