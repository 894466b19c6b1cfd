// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/TileCheck.h"

#include "Core/Inference/Evaluator.h"
#include "Core/Inference/InferenceKernels.h"
#include "Core/Random.h"

#include <algorithm>

namespace inr {

namespace {

/// Every point has the features of one entry, none is interpolated: those are exact, too.
Description DescriptionOf(int levels, int features, int neurons, int hiddenLayers)
{
  Description description;
  description.grid.levels = levels;
  description.grid.features = features;
  description.grid.log2HashmapSize = 10;
  description.grid.baseResolution = 5;
  description.grid.perLevelScale = 1.5f;
  description.grid.interpolation = GridInterpolation::Nearest;
  description.network.neurons = neurons;
  description.network.hiddenLayers = hiddenLayers;
  return description;
}

/// Features are multiples of 2^-7 in [1, 2). Sums over at most 16 columns with weights of 1 and -1
/// are multiples of it, too, and after four layers at most 2^17: 24 digits, as many as float32 has.
/// Rounded to 8 digits in between, they remain multiples.
ModelPointer ExactModel(const Description& description)
{
  constexpr std::uint64_t most = 16;
  const Layout layout(description);
  auto model = std::make_shared<Model>();
  model->description = description;
  model->parameters.resize(layout.parameterCount);
  for (const LayerShape& layer : layout.layers) {
    const auto columns = static_cast<std::uint64_t>(layer.columns);
    for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(layer.rows) * most; ++k) {
      // Places all over the row, each of which comes up only once.
      const std::uint64_t slice = (columns + most - 1) / most;
      const std::uint64_t bits = RandomBits(1, layer.offset * most + k);
      const std::uint64_t column = k % most * slice + bits % slice;
      if (column < columns) {
        model->parameters[layer.offset + k / most * columns + column] =
            (bits >> 32 & 1u) != 0 ? 1.0f : -1.0f;
      }
    }
  }
  for (std::uint64_t k = layout.gridOffset; k < layout.parameterCount; ++k) {
    model->parameters[k] = 1.0f + 0x1p-7f * static_cast<float>(RandomBits(2, k) % 128);
  }
  return model;
}

std::vector<float> ValuesAtPoints(const Evaluator& evaluator)
{
  constexpr std::int64_t first = 201; // the last ones are less than a quarter of a strip,
  constexpr std::int64_t second = 25; // and these less than half
  std::vector<glm::vec3> positions(first + second);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    positions[k] = {RandomUnit(3, 3 * k), RandomUnit(3, 3 * k + 1), RandomUnit(3, 3 * k + 2)};
  }
  std::vector<float> values(positions.size());
  evaluator.evaluate(positions.data(), first, values.data());
  evaluator.evaluate(positions.data() + first, second, values.data() + first);
  return values;
}

std::vector<float> ValuesOnLattice(const Evaluator& evaluator)
{
  std::vector<float> axes[3] = {std::vector<float>(13), std::vector<float>(13),
                                std::vector<float>(2)};
  for (std::uint64_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < axes[axis].size(); ++k) {
      axes[axis][k] = RandomUnit(4, 100 * axis + k);
    }
    std::sort(axes[axis].begin(), axes[axis].end());
  }
  std::vector<float> values(axes[0].size() * axes[1].size() * axes[2].size());
  evaluator.evaluateGrid(axes, values.data());
  return values;
}

} // namespace

bool GiveTheSame(const InferenceKernels& some, const InferenceKernels& others)
{
  // One that fills tiles, and one that leaves rows, columns and pairs empty.
  for (const Description& description :
       {DescriptionOf(8, 8, 64, 3), DescriptionOf(5, 1, 40, 2), DescriptionOf(3, 8, 16, 0)}) {
    const ModelPointer model = ExactModel(description);
    const auto one = MakeEvaluator(model, some);
    const auto other = MakeEvaluator(model, others);
    if (ValuesAtPoints(*one) != ValuesAtPoints(*other) ||
        ValuesOnLattice(*one) != ValuesOnLattice(*other)) {
      return false;
    }
  }
  return true;
}

} // namespace inr
