// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/ModelView.h"

#include "Core/Model/GridIndex.h"

#include <algorithm>
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

std::vector<float> PanelsOf(const LayerView& layer)
{
  const std::size_t panels = static_cast<std::size_t>((layer.rows + PanelRows - 1) / PanelRows);
  std::vector<float> packed(panels * PanelRows * static_cast<std::size_t>(layer.columns));
  for (std::size_t row = 0; row < static_cast<std::size_t>(layer.rows); ++row) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(layer.columns); ++column) {
      const std::size_t columns =
          row / PanelRows * static_cast<std::size_t>(layer.columns) + column;
      packed[columns * PanelRows + row % PanelRows] =
          layer.weights[row * static_cast<std::size_t>(layer.columns) + column];
    }
  }
  return packed;
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
        {parameters + layer.offset, last ? 1 : layer.rows, layer.columns, nullptr});
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

PackedNetwork::PackedNetwork(const ModelView& model)
    : Layers(model.layers, model.layers + model.layerCount), View(model)
{
  for (LayerView& layer : this->Layers) {
    this->Panels.push_back(PanelsOf(layer));
    layer.panels = this->Panels.back().data();
  }
  this->View.layers = this->Layers.data();
}

} // namespace inr
