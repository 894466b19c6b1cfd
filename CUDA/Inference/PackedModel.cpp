// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/PackedModel.h"

#include "CUDA/Inference/Kernels/LatticeShare.h"
#include "Core/Error.h"

#include <algorithm>
#include <cmath>

namespace inr {
namespace cuda {

namespace {

constexpr std::int64_t LatticeBytes = 24 << 10; // of what neighbouring samples share

int TilesFor(int width) { return (width + TileSize - 1) / TileSize; }

/// 1, 2, 4 or 8.
int NeuronTiles(const NetworkDescription& network)
{
  int tiles = 1;
  while (tiles < TilesFor(network.neurons)) {
    tiles *= 2;
  }
  return tiles;
}

/// A layer's weights by row and column, zero beyond its rows and columns.
class PaddedLayer
{
public:
  PaddedLayer(const LayerShape& shape, int rows, const float* parameters)
      : Shape(shape), Rows(rows), Weights(parameters + shape.offset)
  {}

  float at(int row, int column) const
  {
    const bool inside = row < this->Rows && column < this->Shape.columns;
    return inside ? this->Weights[std::int64_t{row} * this->Shape.columns + column] : 0.0f;
  }

private:
  LayerShape Shape;
  int Rows;
  const float* Weights;
};

WeightShare ShareOf(const PaddedLayer& layer, int inputTile, int outputTile, int lane)
{
  WeightShare share{};
  for (int r = 0; r < 4; ++r) {
    const int row = outputTile * TileSize + RowOf(lane) + 8 * (r / 2);
    const int column = inputTile * TileSize + ColumnOf(lane) + 8 * (r % 2);
    share.pairs[r] = PackHalves(layer.at(row, column), layer.at(row, column + 1));
  }
  return share;
}

void AppendLayer(const PaddedLayer& layer, int inputTiles, int outputTiles,
                 std::vector<WeightShare>& weights)
{
  for (int input = 0; input < inputTiles; ++input) {
    for (int output = 0; output < outputTiles; ++output) {
      for (int lane = 0; lane < WarpSize; ++lane) {
        weights.push_back(ShareOf(layer, input, output, lane));
      }
    }
  }
}

} // namespace

void RequireValid(const Model& model)
{
  const Layout layout(model.description);
  if (layout.parameterCount != model.parameters.size()) {
    throw Error(ErrorCode::InvalidModel,
                "the description asks for " + std::to_string(layout.parameterCount) +
                    " parameters, the model has " + std::to_string(model.parameters.size()));
  }
  const auto bad = std::find_if(model.parameters.begin(), model.parameters.end(),
                                [](float parameter) { return !std::isfinite(parameter); });
  if (bad != model.parameters.end()) {
    throw Error(ErrorCode::InvalidModel,
                "parameter " + std::to_string(bad - model.parameters.begin()) +
                    " of the model is " + std::to_string(*bad) + "; train it again");
  }
}

std::string WhyNotHalf(const Model& model)
{
  const NetworkDescription& network = model.description.network;
  if (network.hiddenLayers > 0 && network.neurons > MostFusedNeurons) {
    return "its layers have " + std::to_string(network.neurons) + " neurons, more than " +
           std::to_string(MostFusedNeurons);
  }
  const auto large =
      std::find_if(model.parameters.begin(), model.parameters.end(),
                   [](float parameter) { return !(std::abs(parameter) <= LargestHalf); });
  if (large != model.parameters.end()) {
    return "its parameter " + std::to_string(large - model.parameters.begin()) + " is " +
           std::to_string(*large) + ", beyond +-65504";
  }
  return "";
}

PackedModel::PackedModel(const Model& model)
    : Features(model.description.grid.features),
      Interpolation(model.description.grid.interpolation),
      HiddenLayers(model.description.network.hiddenLayers),
      Hidden(model.description.network.activation),
      Output(model.description.network.outputActivation)
{
  RequireValid(model);
  const std::string reason = WhyNotHalf(model);
  if (!reason.empty()) {
    throw Error(ErrorCode::Unsupported,
                "the model cannot be evaluated in half precision: " + reason);
  }
  const Layout layout(model.description);
  const ModelViewStorage views(model.description, layout, model.parameters.data());
  this->levels.assign(views.view().levels, views.view().levels + views.view().levelCount);
  this->features.reserve(model.parameters.size() - layout.gridOffset);
  std::transform(model.parameters.begin() + static_cast<std::ptrdiff_t>(layout.gridOffset),
                 model.parameters.end(), std::back_inserter(this->features), ToHalf);
  this->inputTiles = TilesFor(layout.encodedWidth);
  this->neuronTiles = this->HiddenLayers > 0 ? NeuronTiles(model.description.network) : 1;
  int inputs = this->inputTiles;
  for (const LayerShape& shape : layout.layers) {
    const bool last = &shape == &layout.layers.back();
    const int outputs = last ? 1 : this->neuronTiles;
    const PaddedLayer layer(shape, last ? 1 : shape.rows, model.parameters.data());
    AppendLayer(layer, inputs, outputs, this->weights);
    inputs = outputs;
  }
}

FusedModel PackedModel::view(const LevelView* levelViews, const HalfBits* table,
                             const WeightShare* shares) const
{
  const auto count = static_cast<int>(this->levels.size());
  return {{levelViews, count, this->Features, this->Interpolation, table},
          {shares, static_cast<std::int64_t>(this->weights.size()), this->inputTiles,
           this->HiddenLayers, this->Hidden, this->Output}};
}

FusedShared PlanShared(const PackedModel& model, bool bricks, std::int64_t roomy, std::int64_t most)
{
  const auto whole = [](std::int64_t bytes) { return (bytes + 15) / 16 * 16; };
  const std::int64_t weights =
      static_cast<std::int64_t>(model.weights.size() * sizeof(WeightShare));
  const std::int64_t rows =
      std::int64_t{ThreadsPerBlock} * RowStride(model.inputTiles) * sizeof(HalfBits);
  const std::int64_t results = sizeof(float) * (bricks ? SamplesPerItem : ThreadsPerBlock);
  const auto levels = static_cast<std::int64_t>(bricks ? model.levels.size() : 0);
  const std::int64_t cells = whole(levels * static_cast<std::int64_t>(sizeof(LevelCells)));
  const std::int64_t plans = whole(levels * static_cast<std::int64_t>(sizeof(LatticePlan)));
  const std::int64_t least = rows + results + cells + plans;
  if (least > most) {
    throw Error(ErrorCode::Unsupported, "the model cannot be evaluated in half precision: its " +
                                            std::to_string(model.levels.size()) +
                                            " grid levels take " + std::to_string(least) +
                                            " bytes of a block's shared memory, which has " +
                                            std::to_string(most));
  }
  const std::int64_t lattice =
      bricks ? std::clamp<std::int64_t>((roomy - least) / 16 * 16, 0, LatticeBytes) : 0;
  FusedShared shared{};
  shared.keepsWeights = least + lattice + weights <= roomy;
  std::int64_t end = shared.keepsWeights ? weights : 0;
  const auto place = [&](std::int64_t bytes) {
    end += bytes;
    return static_cast<std::int32_t>(end - bytes);
  };
  shared.rows = place(rows);
  shared.results = place(results);
  shared.cells = place(cells);
  shared.plans = place(plans);
  shared.lattice = place(lattice);
  shared.latticeEnd = place(0);
  return shared;
}

FloatTables::FloatTables(const Model& model, const float* weights, const float* features)
{
  const Layout layout(model.description);
  const ModelViewStorage views(model.description, layout, weights);
  const ModelView& view = views.view();
  this->levels.assign(view.levels, view.levels + view.levelCount);
  this->layers.assign(view.layers, view.layers + view.layerCount);
  this->View = {{nullptr, view.levelCount, view.features, view.interpolation, features},
                nullptr,
                view.layerCount,
                view.activation,
                view.outputActivation,
                view.widest};
}

FloatModel FloatTables::view(const LevelView* levelViews, const LayerView* layerViews) const
{
  FloatModel view = this->View;
  view.grid.levels = levelViews;
  view.layers = layerViews;
  return view;
}

} // namespace cuda
} // namespace inr
