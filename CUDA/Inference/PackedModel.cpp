// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/PackedModel.h"

#include "CUDA/Inference/Kernels/BrickKernels.h"
#include "Core/Error.h"

#include <algorithm>
#include <cmath>

namespace inr {
namespace cuda {

namespace {

/// Of what neighbouring samples share: rows of the lattice, and of each layer of samples.
constexpr std::int64_t RowBytes = 28 << 10;
constexpr std::int64_t LayerBytes = RowBytes / 4;

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

/// A lane's share of a tile of weights from (row, column) on.
void AppendShare(const PaddedLayer& layer, int row, int column, int lane, bool /*second*/,
                 std::vector<WeightShare>& weights)
{
  WeightShare& share = weights.emplace_back();
  for (int r = 0; r < 4; ++r) {
    const int output = row + RowOf(lane) + 8 * (r / 2);
    const int input = column + ColumnOf(lane) + 8 * (r % 2);
    share.pairs[r] = PackHalves(layer.at(output, input), layer.at(output, input + 1));
  }
}
/// The same of the weights' first parts, or of what these leave out.
void AppendShare(const PaddedLayer& layer, int row, int column, int lane, bool second,
                 std::vector<WideWeightShare>& weights)
{
  WideWeightShare& share = weights.emplace_back();
  for (int v = 0; v < 4; ++v) {
    const float weight = layer.at(row + RowOf(lane), column + ColumnOf(lane) + v % 2 + 8 * (v / 2));
    const float first = ToElevenBits(weight);
    share.values[v] = second ? ToElevenBits(weight - first) : first;
  }
}

template <class Numbers>
void AppendLayer(const PaddedLayer& layer, int inputTiles, int outputTiles, bool second,
                 std::vector<typename Numbers::Weight>& weights)
{
  constexpr int rows = TileSize / Numbers::WeightShares; // of a share
  for (int input = 0; input < inputTiles; ++input) {
    for (int output = 0; output < outputTiles * Numbers::WeightShares; ++output) {
      for (int lane = 0; lane < WarpSize; ++lane) {
        AppendShare(layer, output * rows, input * TileSize, lane, second, weights);
      }
    }
  }
}

/// Whether some weight has more than 11 bits.
bool HasMoreThanElevenBits(const float* weights, std::size_t count)
{
  return std::any_of(weights, weights + count, [](float w) { return ToElevenBits(w) != w; });
}

std::vector<HalfBits> FeaturesAs(const HalfBits& /*kind*/, const float* from, const float* end)
{
  std::vector<HalfBits> features;
  features.reserve(static_cast<std::size_t>(end - from));
  std::transform(from, end, std::back_inserter(features), ToHalf);
  return features;
}
std::vector<float> FeaturesAs(float /*kind*/, const float* from, const float* end)
{
  return {from, end};
}

/// Why a model cannot be packed so, or nothing.
std::string WhyNot(const HalfNumbers& /*numbers*/, const Model& model) { return WhyNotHalf(model); }
std::string WhyNot(const FloatNumbers& /*numbers*/, const Model& model)
{
  return WhyNotFused(model);
}
const char* NameOf(const HalfNumbers& /*numbers*/) { return "in half precision"; }
const char* NameOf(const FloatNumbers& /*numbers*/) { return "by tensor cores"; }

} // namespace

std::string WhyNotFused(const Model& model)
{
  const NetworkDescription& network = model.description.network;
  return network.hiddenLayers > 0 && network.neurons > MostFusedNeurons
             ? "its layers have " + std::to_string(network.neurons) + " neurons, more than " +
                   std::to_string(MostFusedNeurons)
             : "";
}

std::string WhyNotHalf(const Model& model)
{
  const auto large =
      std::find_if(model.parameters.begin(), model.parameters.end(),
                   [](float parameter) { return !(std::abs(parameter) <= LargestHalf); });
  if (large != model.parameters.end()) {
    return "its parameter " + std::to_string(large - model.parameters.begin()) + " is " +
           std::to_string(*large) + ", beyond +-65504";
  }
  return WhyNotFused(model);
}

template <class Numbers>
PackedModel<Numbers>::PackedModel(const Model& model, bool withFeatures)
    : Features(model.description.grid.features),
      Interpolation(model.description.grid.interpolation),
      HiddenLayers(model.description.network.hiddenLayers),
      Hidden(model.description.network.activation),
      Output(model.description.network.outputActivation)
{
  const Layout layout = CheckedLayout(model);
  const std::string reason = WhyNot(Numbers(), model);
  if (!reason.empty()) {
    throw Error(ErrorCode::Unsupported,
                std::string("the model cannot be evaluated ") + NameOf(Numbers()) + ": " + reason);
  }
  const float* const parameters = model.parameters.data();
  const ModelViewStorage views(model.description, layout, parameters);
  this->levels.assign(views.view().levels, views.view().levels + views.view().levelCount);
  if (withFeatures) {
    this->features =
        FeaturesAs(Feature(), parameters + layout.gridOffset, parameters + model.parameters.size());
  }
  this->inputTiles = TilesFor(layout.encodedWidth);
  this->neuronTiles = this->HiddenLayers > 0 ? NeuronTiles(model.description.network) : 1;
  this->hasSecond = Numbers::HasSecondWeights &&
                    HasMoreThanElevenBits(parameters, static_cast<std::size_t>(layout.gridOffset));
  int inputs = this->inputTiles;
  for (const LayerShape& shape : layout.layers) {
    const bool last = &shape == &layout.layers.back();
    const int outputs = last ? 1 : this->neuronTiles;
    const PaddedLayer layer(shape, last ? 1 : shape.rows, parameters);
    for (int part = 0; part < (this->hasSecond ? 2 : 1); ++part) {
      AppendLayer<Numbers>(layer, inputs, outputs, part == 1, this->weights);
    }
    inputs = outputs;
  }
}

template <class Numbers>
FusedModel<Numbers> PackedModel<Numbers>::view(const LevelView* levelViews, const Feature* table,
                                               const Weight* shares) const
{
  const auto count = static_cast<int>(this->levels.size());
  return {{levelViews, count, this->Features, this->Interpolation, table},
          {shares, static_cast<std::int64_t>(this->weights.size()), this->hasSecond,
           this->inputTiles, this->HiddenLayers, this->Hidden, this->Output}};
}

template struct PackedModel<HalfNumbers>;
template struct PackedModel<FloatNumbers>;

namespace {

/// Bytes of a block's shared memory that cannot be left out.
struct SharedParts
{
  std::int64_t rows;
  std::int64_t results;
  std::int64_t coordinates;
  std::int64_t parts;

  template <class Numbers>
  SharedParts(const PackedModel<Numbers>& model, bool bricks)
      : rows(bricks ? 0
                    : std::int64_t{ThreadsPerBlock} * RowStride(model.inputTiles) *
                          static_cast<std::int64_t>(sizeof(typename Numbers::Staged))),
        results(sizeof(float) * (bricks ? SamplesPerItem : ThreadsPerBlock)),
        coordinates(bricks ? Whole(3 * ItemSize * sizeof(float)) : 0),
        parts(bricks ? Whole(model.levels.size() * sizeof(LevelPart)) : 0)
  {}

  std::int64_t all() const { return this->rows + this->results + this->coordinates + this->parts; }

private:
  static std::int64_t Whole(std::size_t bytes)
  {
    return static_cast<std::int64_t>((bytes + 15) / 16 * 16);
  }
};

} // namespace

template <class Numbers> bool FitsShared(const PackedModel<Numbers>& model, std::int64_t most)
{
  return SharedParts(model, false).all() <= most && SharedParts(model, true).all() <= most;
}

template bool FitsShared(const PackedModel<HalfNumbers>&, std::int64_t);
template bool FitsShared(const PackedModel<FloatNumbers>&, std::int64_t);

template <class Numbers>
FusedShared PlanShared(const PackedModel<Numbers>& model, bool bricks, std::int64_t roomy,
                       std::int64_t most)
{
  const SharedParts parts(model, bricks);
  const std::int64_t least = parts.all();
  if (least > most) {
    throw Error(ErrorCode::Unsupported,
                std::string("the model cannot be evaluated ") + NameOf(Numbers()) + ": its " +
                    std::to_string(model.levels.size()) + " grid levels take " +
                    std::to_string(least) + " bytes of a block's shared memory, which has " +
                    std::to_string(most));
  }
  const auto weights =
      static_cast<std::int64_t>(model.weights.size() * sizeof(typename Numbers::Weight));
  const int layers = LayersAtOnce<Numbers>(model.neuronTiles);
  const std::int64_t wanted = bricks ? RowBytes + layers * LayerBytes : 0;
  FusedShared shared{};
  shared.keepsWeights = roomy - least - weights >= wanted / 2;
  const std::int64_t rest = roomy - least - (shared.keepsWeights ? weights : 0);
  const std::int64_t lattice = std::clamp<std::int64_t>(rest, 0, wanted);
  const std::int64_t row = sizeof(float) * ItemSize * model.view().grid.features;
  const std::int64_t ofLayer = lattice * LayerBytes / (RowBytes + layers * LayerBytes) / row;
  shared.room.ofLayer = static_cast<std::int32_t>(ofLayer);
  shared.room.rows = static_cast<std::int32_t>(lattice / row - layers * ofLayer);
  std::int64_t end = shared.keepsWeights ? weights : 0;
  const auto place = [&](std::int64_t bytes) {
    end += bytes;
    return static_cast<std::int32_t>(end - bytes);
  };
  shared.rows = place(parts.rows);
  shared.results = place(parts.results);
  shared.coordinates = place(parts.coordinates);
  shared.parts = place(parts.parts);
  shared.lattice = place(shared.room.rows * row);
  shared.mixed = place(layers * ofLayer * row);
  shared.end = place(0);
  return shared;
}

template FusedShared PlanShared(const PackedModel<HalfNumbers>&, bool, std::int64_t, std::int64_t);
template FusedShared PlanShared(const PackedModel<FloatNumbers>&, bool, std::int64_t, std::int64_t);

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
