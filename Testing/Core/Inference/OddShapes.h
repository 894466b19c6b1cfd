// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Testing/Core/RandomModel.h"

#include <vector>

inline inr::Description ShapeOf(int levels, int features, int neurons, int hiddenLayers,
                                inr::Activation activation = inr::Activation::ReLU)
{
  inr::Description description = SmallDescription();
  description.grid.levels = levels;
  description.grid.features = features;
  description.network.neurons = neurons;
  description.network.hiddenLayers = hiddenLayers;
  description.network.activation = activation;
  return description;
}

/// Widths that no pair, panel, tile or vector of the kernels divides, and activations that go
/// through memory or leave no zeros.
inline std::vector<inr::Description> OddShapes()
{
  using inr::Activation;
  std::vector<inr::Description> all = {
      SmallDescription(),
      ShapeOf(5, 1, 16, 2, Activation::Tanh),
      ShapeOf(8, 8, 64, 3),
      ShapeOf(4, 4, 16, 2, Activation::None),
      ShapeOf(3, 2, 19, 2), // no row of weights begins where the last one's vector ends
      ShapeOf(1, 1, 33, 1, Activation::Exponential),
      ShapeOf(3, 8, 8, 2, Activation::Squareplus),
      ShapeOf(4, 8, 16, 0),
      ShapeOf(5, 1, 128, 2, Activation::LeakyReLU),
      ShapeOf(16, 8, 48, 1, Activation::Sigmoid),
      ShapeOf(1, 1, 8, 2), // less than a tile
  };
  all[3].network.outputActivation = Activation::LeakyReLU;
  all[4].network.outputActivation = Activation::Softplus;
  all[6].network.alignment = all[10].network.alignment = 8;
  all[7].network.outputActivation = Activation::Sine;
  return all;
}
