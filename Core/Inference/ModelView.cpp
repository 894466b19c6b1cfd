// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/ModelView.h"

#include "Core/Inference/TileShapes.h"
#include "Core/Model/GridIndex.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace inr {

namespace {

/// An unwrapped dense index counts res^3 points and one alias per axis: below 2 * entries.
bool IsPlainDense(const GridLevel& level)
{
  const std::uint64_t resolution = level.resolution;
  return resolution <= 1290 && resolution * resolution * resolution <= level.entries;
}

IndexWrap ChooseWrap(const GridLevel& level)
{
  if ((level.entries & (level.entries - 1)) == 0) {
    return IndexWrap::Mask;
  }
  return !level.hashed && IsPlainDense(level) ? IndexWrap::Subtract : IndexWrap::Modulo;
}

LevelView ViewOf(const GridDescription& grid, const GridLevel& level)
{
  LevelView view{};
  view.scale = level.scale;
  view.entries = level.entries;
  view.wrap = ChooseWrap(level);
  view.hashed = level.hashed;
  view.randomHash = grid.hash == HashFunction::Rng;
  view.offset = level.offset * static_cast<std::uint64_t>(grid.features);
  const HashPrimes primes = PrimesOf(grid.hash);
  view.primes[0] = primes.x;
  view.primes[1] = primes.y;
  view.primes[2] = primes.z;
  std::copy(std::begin(level.stride), std::end(level.stride), view.strides);
  return view;
}

/// Elements for `columns` columns of a layer's rows, elementOf(row, column) each.
template <class Element, class ElementOf>
std::vector<Element> PackedIn(std::size_t columns, const LayerView& layer,
                              const ElementOf& elementOf)
{
  const auto rows = static_cast<std::size_t>(layer.rows);
  std::vector<Element> packed((rows + PanelRows - 1) / PanelRows * PanelRows * columns);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      packed[(row / PanelRows * columns + column) * PanelRows + row % PanelRows] =
          elementOf(row, column);
    }
  }
  return packed;
}

std::vector<float> PanelsOf(const LayerView& layer)
{
  const auto columns = static_cast<std::size_t>(layer.columns);
  return PackedIn<float>(columns, layer, [&](std::size_t row, std::size_t column) {
    return layer.weights[row * columns + column];
  });
}

/// The bits of a finite number as bfloat16, to nearest and, halfway, to even.
std::uint32_t BFloat16BitsOf(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  return (bits + 0x7fffu + (bits >> 16 & 1u)) >> 16;
}

/// What rounding to bfloat16 takes from a number.
float RestOf(float value)
{
  const std::uint32_t bits = BFloat16BitsOf(value) << 16;
  float rounded;
  std::memcpy(&rounded, &bits, sizeof(rounded));
  return value - rounded;
}

/// Weights of a row's columns 2 * pair and the next, or what rounding takes from them.
std::uint32_t PairOf(const LayerView& layer, std::size_t row, std::size_t pair, bool rests = false)
{
  const auto columns = static_cast<std::size_t>(layer.columns);
  const float* const weights = layer.weights + row * columns + 2 * pair;
  const float second = 2 * pair + 1 < columns ? weights[1] : 0.0f;
  return rests ? BFloat16BitsOf(RestOf(weights[0])) | BFloat16BitsOf(RestOf(second)) << 16
               : BFloat16BitsOf(weights[0]) | BFloat16BitsOf(second) << 16;
}

std::size_t PairCount(const LayerView& layer)
{
  return (static_cast<std::size_t>(layer.columns) + 1) / 2;
}

std::vector<std::uint32_t> PairsOf(const LayerView& layer)
{
  return PackedIn<std::uint32_t>(PairCount(layer), layer, [&](std::size_t row, std::size_t pair) {
    return PairOf(layer, row, pair);
  });
}

} // namespace

std::uint32_t RandomHashOfCorner(std::uint32_t x, std::uint32_t y, std::uint32_t z)
{
  return HashCorner(HashFunction::Rng, x, y, z);
}

ModelViewStorage::ModelViewStorage(const Description& description, const Layout& layout,
                                   const float* parameters)
{
  for (const GridLevel& level : layout.levels) {
    this->Levels.push_back(ViewOf(description.grid, level));
  }
  for (const LayerShape& layer : layout.layers) {
    const bool last = &layer == &layout.layers.back();
    this->Layers.push_back(
        {parameters + layer.offset, last ? 1 : layer.rows, layer.columns, nullptr, nullptr});
    this->View.widest = std::max({this->View.widest, layer.rows, layer.columns});
  }
  this->View.levels = this->Levels.data();
  this->View.levelCount = static_cast<int>(this->Levels.size());
  this->View.features = description.grid.features;
  this->View.interpolation = description.grid.interpolation;
  this->View.grid = parameters + layout.gridOffset;
  this->View.layers = this->Layers.data();
  this->View.layerCount = static_cast<int>(this->Layers.size());
  this->View.activation = description.network.activation;
  this->View.outputActivation = description.network.outputActivation;
  this->View.encodedWidth = layout.encodedWidth;
  this->View.inputWidth = layout.inputWidth;
}

std::vector<PackedNetwork::Line> PackedNetwork::TilesOf(const LayerView& layer, std::size_t parts)
{
  constexpr std::size_t size = TileSize;
  const auto rows = static_cast<std::size_t>(layer.rows);
  const std::size_t tiles = (PairCount(layer) + size - 1) / size;
  std::vector<Line> lines((rows + size - 1) / size * tiles * parts * size);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t pair = 0; pair < PairCount(layer); ++pair) {
      for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t tile = (row / size * tiles + pair / size) * parts + part;
        lines[tile * size + row % size].pairs[pair % size] = PairOf(layer, row, pair, part == 1);
      }
    }
  }
  return lines;
}

PackedNetwork::PackedNetwork(const ModelView& model, WeightLayout layout)
    : Layers(model.layers, model.layers + model.layerCount), View(model)
{
  for (LayerView& layer : this->Layers) {
    switch (layout) {
    case WeightLayout::Panels:
      this->Panels.push_back(PanelsOf(layer));
      layer.panels = this->Panels.back().data();
      break;
    case WeightLayout::Pairs:
      this->Pairs.push_back(PairsOf(layer));
      layer.pairs = this->Pairs.back().data();
      break;
    case WeightLayout::Tiles:
    case WeightLayout::SplitTiles:
      this->Tiles.push_back(TilesOf(layer, layout == WeightLayout::SplitTiles ? 2 : 1));
      layer.pairs = this->Tiles.back().data()->pairs;
      break;
    }
  }
  this->View.layers = this->Layers.data();
}

} // namespace inr
