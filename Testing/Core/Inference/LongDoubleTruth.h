// SPDX-License-Identifier: BSD-3-Clause
//
// An INR evaluated in long double, whose range no model of floats leaves, together with a bound of
// what float32 arithmetic may lose, of factors that may be rounded before. Shares no code with the
// kernels but the layout of parameters.
#pragma once

#include "Core/Model/GridIndex.h"
#include "Core/Model/Model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

/// A number and how far float32 arithmetic may be from it.
struct Bounded
{
  long double value = 0;
  long double error = 0;
};

/// How kernels multiply that round weights and what goes into a layer and take the smallest numbers
/// for zero.
struct RoundedProducts
{
  long double error = 0; ///< by how much of itself a product is off at most; 0: nothing is rounded
  int count = 1;         ///< of those that stand for one
};

class LongDoubleTruth
{
public:
  explicit LongDoubleTruth(const inr::Model& model, const RoundedProducts& products = {})
      : Source(model), Shape(model.description), Products(products)
  {}

  Bounded operator()(const glm::vec3& position) const
  {
    std::vector<Bounded> values = this->encode(position);
    for (std::size_t l = 0; l < this->Shape.layers.size(); ++l) {
      const bool last = l + 1 == this->Shape.layers.size();
      const inr::NetworkDescription& network = this->Source.description.network;
      values = this->multiply(this->Shape.layers[l], values, last ? 1 : this->Shape.layers[l].rows);
      for (Bounded& value : values) {
        value = Activated(last ? network.outputActivation : network.activation, value);
      }
    }
    values[0].error += this->Products.error > 0 ? 0x1p-30L : 0;
    return values[0];
  }

private:
  static constexpr long double Ulp = 0x1p-24L;   ///< half a unit in the last place of 1
  static constexpr long double Tiny = 0x1p-149L; ///< smallest float
  /// Nothing is claimed of models with larger numbers inside: the library saturates soon after.
  static constexpr long double KnownBelow = 1e260L;
  static constexpr long double Limit = 1e2000L;

  struct Cell
  {
    std::uint32_t lower[3];
    long double weight[3];
  };

  Cell locate(const inr::GridLevel& level, const glm::vec3& position) const
  {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
      const float u = position[axis] > 0 ? std::min(position[axis], 1.0f) : 0.0f;
      const long double at = static_cast<long double>(u) * level.scale + 0.5L;
      cell.lower[axis] = static_cast<std::uint32_t>(at);
      const long double w = at - cell.lower[axis];
      switch (this->Source.description.grid.interpolation) {
      case inr::GridInterpolation::Linear:
        cell.weight[axis] = w;
        break;
      case inr::GridInterpolation::Smoothstep:
        cell.weight[axis] = w * w * (3 - 2 * w);
        break;
      case inr::GridInterpolation::Nearest:
        cell.weight[axis] = 0;
        break;
      }
    }
    return cell;
  }

  std::vector<Bounded> encode(const glm::vec3& position) const
  {
    std::vector<Bounded> features;
    const inr::GridDescription& grid = this->Source.description.grid;
    for (const inr::GridLevel& level : this->Shape.levels) {
      const Cell cell = this->locate(level, position);
      std::vector<Bounded> sums(static_cast<std::size_t>(grid.features));
      for (std::uint32_t corner = 0; corner < 8; ++corner) {
        const std::uint32_t bit[3] = {corner & 1u, corner >> 1 & 1u, corner >> 2};
        long double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
          weight *= bit[axis] != 0 ? cell.weight[axis] : 1 - cell.weight[axis];
        }
        const std::uint64_t entry =
            level.offset + inr::GridIndex(level, grid.hash, cell.lower[0] + bit[0],
                                          cell.lower[1] + bit[1], cell.lower[2] + bit[2]);
        for (std::size_t f = 0; f < sums.size(); ++f) {
          const long double feature =
              this->Source.parameters[this->Shape.gridOffset + entry * sums.size() + f];
          sums[f].value += weight * feature;
          // Each of the eight weights is wrong by a few last places of 1, not of itself.
          sums[f].error += 16 * Ulp * std::abs(feature) + 8 * Tiny;
        }
      }
      features.insert(features.end(), sums.begin(), sums.end());
    }
    return features;
  }

  /// The bounds that Evaluator.h states.
  std::vector<Bounded> multiply(const inr::LayerShape& layer, const std::vector<Bounded>& in,
                                int rows) const
  {
    std::vector<Bounded> out(static_cast<std::size_t>(rows));
    for (std::size_t row = 0; row < out.size(); ++row) {
      const float* weights = this->Source.parameters.data() + layer.offset +
                             row * static_cast<std::size_t>(layer.columns);
      long double magnitudes = 0;
      for (std::size_t column = 0; column < in.size(); ++column) {
        const long double weight = weights[column];
        out[row].value += weight * in[column].value;
        out[row].error += std::abs(weight) * in[column].error;
        magnitudes += std::abs(weight) * (std::abs(in[column].value) + in[column].error);
      }
      const auto count = static_cast<long double>(in.size()) * this->Products.count;
      out[row].error += (this->Products.error + (count + 2) * Ulp) * magnitudes + count * Tiny;
    }
    return out;
  }

  static long double Exact(inr::Activation activation, long double x)
  {
    switch (activation) {
    case inr::Activation::ReLU:
      return std::max(x, 0.0L);
    case inr::Activation::LeakyReLU:
      return x > 0 ? x : x / 100;
    case inr::Activation::Exponential:
      return std::exp(x);
    case inr::Activation::Sigmoid:
      return 0.5L + 0.5L * std::tanh(x / 2);
    case inr::Activation::Sine:
      return std::sin(x);
    case inr::Activation::Squareplus:
      return x / 2 + std::sqrt(x * x / 4 + 0.01L);
    case inr::Activation::Softplus:
      return x > 0 ? x + std::log1p(std::exp(-10 * x)) / 10 : std::log1p(std::exp(10 * x)) / 10;
    case inr::Activation::Tanh:
      return std::tanh(x);
    default:
      return x;
    }
  }

  /// The slopes are at most 1, but for the exponential's.
  static Bounded Activated(inr::Activation activation, const Bounded& x)
  {
    using inr::Activation;
    const long double y = std::min(Exact(activation, x.value), Limit);
    long double error = x.error;
    long double scale = std::abs(y);
    switch (activation) {
    case Activation::Exponential:
      error = std::min(std::exp(x.value + x.error), Limit) - y;
      break;
    case Activation::Sine:
    case Activation::Tanh:
    case Activation::Sigmoid:
      error = std::min(error, 2.0L);
      break;
    case Activation::Squareplus: // differences of numbers as large as the argument
    case Activation::Softplus:
      scale += std::abs(x.value);
      break;
    default:
      break;
    }
    error += 8 * Ulp * scale + 8 * Tiny;
    return {y, scale < KnownBelow ? error : Limit};
  }

  const inr::Model& Source;
  inr::Layout Shape;
  RoundedProducts Products;
};
