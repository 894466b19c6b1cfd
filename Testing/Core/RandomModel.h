// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Model.h"
#include "Core/Random.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

/// A small INR whose parameters are uniform in [-1, 1]: not trained on anything.
inline std::shared_ptr<inr::Model> RandomModel(const inr::Description& description,
                                               std::uint64_t seed = 1)
{
  auto model = std::make_shared<inr::Model>();
  model->description = description;
  model->parameters.resize(inr::Layout(description).parameterCount);
  for (std::size_t k = 0; k < model->parameters.size(); ++k) {
    model->parameters[k] = 2.0f * inr::RandomUnit(seed, k) - 1.0f;
  }
  return model;
}

/// The same, but sums stay about as large as features.
inline std::shared_ptr<inr::Model> CalmModel(const inr::Description& description)
{
  auto model = RandomModel(description);
  const inr::Layout layout(description);
  for (const inr::LayerShape& layer : layout.layers) {
    const auto begin = model->parameters.begin() + static_cast<std::ptrdiff_t>(layer.offset);
    std::for_each(begin, begin + std::ptrdiff_t{layer.rows} * layer.columns,
                  [&](float& weight) { weight *= 2.0f / std::sqrt(float(layer.columns)); });
  }
  return model;
}

inline inr::Description SmallDescription()
{
  inr::Description description;
  description.grid.levels = 4;
  description.grid.features = 4;
  description.grid.log2HashmapSize = 9;
  description.grid.baseResolution = 6;
  description.network.neurons = 16;
  description.network.hiddenLayers = 2;
  return description;
}

inline std::vector<glm::vec3> RandomPositions(std::int64_t count, std::uint64_t seed = 7)
{
  std::vector<glm::vec3> positions(static_cast<std::size_t>(count));
  std::uint64_t counter = 0;
  for (glm::vec3& position : positions) {
    for (int axis = 0; axis < 3; ++axis) {
      position[axis] = inr::RandomUnit(seed, counter++);
    }
  }
  return positions;
}
