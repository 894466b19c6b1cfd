// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/WideEvaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace inr {

namespace {

struct AxisCell
{
  std::uint32_t cell;
  double weight;
};

/// In float as the kernels do it, so that a position on a face falls into the same cell.
AxisCell Locate(const LevelView& level, GridInterpolation interpolation, float u)
{
  const float position = u * level.scale;
  const float raised = position + 0.5f;
  auto cell = static_cast<std::int32_t>(raised);
  const double lost = static_cast<double>(u) * static_cast<double>(level.scale) - position;
  float weight = ((position - static_cast<float>(cell)) + 0.5f) + static_cast<float>(lost);
  const int move = weight < 0.0f ? -1 : (weight >= 1.0f ? 1 : 0);
  cell += move;
  weight -= static_cast<float>(move);
  const double w = weight;
  switch (interpolation) {
  case GridInterpolation::Smoothstep:
    return {static_cast<std::uint32_t>(cell), w * w * (3.0 - 2.0 * w)};
  case GridInterpolation::Nearest:
    return {static_cast<std::uint32_t>(cell), 0.0};
  default:
    return {static_cast<std::uint32_t>(cell), w};
  }
}

std::uint64_t EntryOf(const LevelView& level, std::uint32_t x, std::uint32_t y, std::uint32_t z)
{
  std::uint32_t index = x * level.strides[0] + y * level.strides[1] + z * level.strides[2];
  if (level.hashed) {
    index = level.randomHash
                ? RandomHashOfCorner(x, y, z)
                : (x * level.primes[0]) ^ (y * level.primes[1]) ^ (z * level.primes[2]);
  }
  return index % level.entries;
}

void EncodeLevel(const ModelView& model, const LevelView& level, const float* position,
                 double* features)
{
  AxisCell axes[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float u = position[axis] > 0.0f ? std::min(position[axis], 1.0f) : 0.0f; // NaN: 0
    axes[axis] = Locate(level, model.interpolation, u);
  }
  std::fill_n(features, model.features, 0.0);
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    std::uint32_t at[3];
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::uint32_t upper = corner >> axis & 1u;
      at[axis] = axes[axis].cell + upper;
      weight *= upper != 0 ? axes[axis].weight : 1.0 - axes[axis].weight;
    }
    const auto count = static_cast<std::uint64_t>(model.features);
    const float* entry = model.grid + level.offset + EntryOf(level, at[0], at[1], at[2]) * count;
    for (std::uint64_t f = 0; f < count; ++f) {
      features[f] += weight * static_cast<double>(entry[f]);
    }
  }
}

double Activated(Activation activation, double x)
{
  const double y = 10.0 * x;
  switch (activation) {
  case Activation::ReLU:
    return std::max(x, 0.0);
  case Activation::LeakyReLU:
    return x > 0.0 ? x : 0.01 * x;
  case Activation::Exponential:
    return std::exp(x);
  case Activation::Sigmoid:
    return 1.0 / (1.0 + std::exp(-x));
  case Activation::Sine:
    return std::sin(x);
  case Activation::Squareplus: // 0.05 (y + sqrt(y^2 + 4)), neither squared nor cancelled
    return y > 0.0 ? 0.05 * (y + std::hypot(y, 2.0)) : 0.2 / (std::hypot(y, 2.0) - y);
  case Activation::Softplus:
    return 0.1 * (std::max(y, 0.0) + std::log1p(std::exp(-std::abs(y))));
  case Activation::Tanh:
    return std::tanh(x);
  default:
    return x;
  }
}

void RunLayer(const LayerView& layer, int columns, Activation activation,
              const std::vector<double>& in, std::vector<double>& out)
{
  for (int row = 0; row < layer.rows; ++row) {
    const float* weights = layer.weights + static_cast<std::int64_t>(row) * layer.columns;
    double sum = 0;
    for (int column = 0; column < columns; ++column) {
      sum += static_cast<double>(weights[column]) * in[static_cast<std::size_t>(column)];
    }
    out[static_cast<std::size_t>(row)] =
        std::clamp(Activated(activation, sum), -WideLimit, WideLimit);
  }
}

} // namespace

float EvaluateWide(const ModelView& model, const float* position)
{
  std::vector<double> in(static_cast<std::size_t>(model.widest));
  std::vector<double> out(in.size());
  for (int l = 0; l < model.levelCount; ++l) {
    EncodeLevel(model, model.levels[l], position,
                in.data() + static_cast<std::int64_t>(l) * model.features);
  }
  for (int l = 0; l < model.layerCount; ++l) {
    const bool last = l + 1 == model.layerCount;
    RunLayer(model.layers[l], l == 0 ? model.encodedWidth : model.layers[l].columns,
             last ? model.outputActivation : model.activation, in, out);
    std::swap(in, out);
  }
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(in[0], -largest, largest));
}

} // namespace inr
