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
    this->Layers.push_back({parameters + layer.offset, last ? 1 : layer.rows, layer.columns});
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

} // namespace inr
