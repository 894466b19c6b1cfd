// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Description.h"

#include "Core/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace inr {
namespace {

constexpr std::uint64_t MaximumParameters = std::numeric_limits<std::int32_t>::max();
constexpr std::uint64_t MaximumLevelEntries = std::numeric_limits<std::int32_t>::max();
// The finest lattice whose cubed resolution fits 32 bits; finer ones are always hashed by the exact
// rule.
constexpr std::uint32_t MaximumExactResolution = 1625;

void RequireRange(const char* what, std::int64_t value, std::int64_t low, std::int64_t high)
{
  if (value < low || value > high) {
    throw Error(ErrorCode::InvalidModel, std::string(what) + " is " + std::to_string(value) +
                                             "; it must be between " + std::to_string(low) +
                                             " and " + std::to_string(high));
  }
}

void RequireValid(const GridDescription& grid)
{
  RequireRange("the number of grid levels", grid.levels, 1, 128);
  RequireRange("the number of features per level", grid.features, 1, 8);
  if ((grid.features & (grid.features - 1)) != 0) {
    throw Error(ErrorCode::InvalidModel, "the number of features per level is " +
                                             std::to_string(grid.features) +
                                             "; it must be 1, 2, 4 or 8");
  }
  RequireRange("log2 of the hash map size", grid.log2HashmapSize, 0, 30);
  RequireRange("the base resolution", grid.baseResolution, 1, 1 << 20);
  if (!(grid.perLevelScale >= 1.0f) || !std::isfinite(grid.perLevelScale)) {
    throw Error(ErrorCode::InvalidModel, "the scale per level is " +
                                             std::to_string(grid.perLevelScale) +
                                             "; it must be a finite number of at least 1");
  }
}

void RequireValid(const NetworkDescription& network)
{
  RequireRange("the number of neurons", network.neurons, 1, 1024);
  RequireRange("the number of hidden layers", network.hiddenLayers, 0, 64);
  if (network.alignment != 8 && network.alignment != 16) {
    throw Error(ErrorCode::InvalidModel, "the network's alignment is " +
                                             std::to_string(network.alignment) +
                                             "; it must be 8 or 16");
  }
}

std::uint64_t RoundUp(std::uint64_t value, std::uint64_t multiple)
{
  return (value + multiple - 1) / multiple * multiple;
}

// tiny-cuda-nn's formula, in float32 as written there: the ceil that follows it is sensitive.
float LevelScale(const GridDescription& grid, int level)
{
  const float exponent = static_cast<float>(level) * std::log2(grid.perLevelScale);
  const float scale = std::exp2(exponent) * static_cast<float>(grid.baseResolution) - 1.0f;
  if (!(scale < 0x1p30f)) {
    throw Error(ErrorCode::InvalidModel, "grid level " + std::to_string(level) +
                                             " is finer than 2^30 points per axis; use fewer "
                                             "levels or a smaller scale per level");
  }
  return scale;
}

std::uint32_t LevelEntries(const GridDescription& grid, std::uint64_t resolution)
{
  const auto cube = [](std::uint64_t n) { return n * n * n; };
  // 2^11 cubed is already over the limit, so larger resolutions need no (overflowing) cube.
  const bool huge = resolution >= 2048;
  const std::uint64_t dense = huge ? MaximumLevelEntries : cube(resolution);
  const std::uint64_t entries = RoundUp(std::min(dense, MaximumLevelEntries), 8);
  switch (grid.type) {
  case GridType::Hash:
    return static_cast<std::uint32_t>(std::min(entries, std::uint64_t{1} << grid.log2HashmapSize));
  case GridType::Tiled:
    return static_cast<std::uint32_t>(
        std::min(entries, cube(static_cast<std::uint64_t>(grid.baseResolution))));
  case GridType::Dense:
    break;
  }
  return static_cast<std::uint32_t>(entries);
}

// The running stride in 32 bits that may wrap, as before June 2025.
std::uint32_t WrappingStrides(GridLevel& level)
{
  std::uint32_t stride = 1;
  for (std::uint32_t& axis : level.stride) {
    axis = 0;
    if (stride <= level.entries) {
      axis = stride;
      stride *= level.resolution;
    }
  }
  return stride;
}

std::uint32_t ExactStrides(GridLevel& level)
{
  if (level.resolution > MaximumExactResolution) {
    std::fill(std::begin(level.stride), std::end(level.stride), 0u);
    return std::numeric_limits<std::uint32_t>::max();
  }
  std::uint32_t stride = 1;
  for (std::uint32_t& axis : level.stride) {
    axis = stride;
    stride *= level.resolution;
  }
  return stride;
}

GridLevel MakeLevel(const GridDescription& grid, int index, std::uint64_t offset)
{
  GridLevel level;
  level.scale = LevelScale(grid, index);
  level.resolution = static_cast<std::uint32_t>(std::ceil(level.scale)) + 1;
  level.entries = LevelEntries(grid, level.resolution);
  level.offset = offset;
  const std::uint32_t stride =
      grid.rule == HashRule::Wrapping ? WrappingStrides(level) : ExactStrides(level);
  level.hashed = grid.type == GridType::Hash && stride > level.entries;
  return level;
}

std::uint64_t AppendLayer(std::vector<LayerShape>& layers, int rows, int columns,
                          std::uint64_t offset)
{
  layers.push_back({rows, columns, offset});
  return offset + static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns);
}

} // namespace

Layout::Layout(const Description& description)
{
  const GridDescription& grid = description.grid;
  const NetworkDescription& network = description.network;
  RequireValid(grid);
  RequireValid(network);

  const auto padded = [&](int width) {
    return static_cast<int>(
        RoundUp(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(network.alignment)));
  };
  this->encodedWidth = grid.levels * grid.features;
  this->inputWidth = padded(this->encodedWidth);
  this->outputWidth = padded(1);

  int width = this->inputWidth;
  for (int layer = 0; layer < network.hiddenLayers; ++layer) {
    this->gridOffset = AppendLayer(this->layers, network.neurons, width, this->gridOffset);
    width = network.neurons;
  }
  this->gridOffset = AppendLayer(this->layers, this->outputWidth, width, this->gridOffset);

  std::uint64_t entries = 0;
  for (int level = 0; level < grid.levels; ++level) {
    this->levels.push_back(MakeLevel(grid, level, entries));
    entries += this->levels.back().entries;
  }
  this->parameterCount = this->gridOffset + entries * static_cast<std::uint64_t>(grid.features);
  if (this->parameterCount > MaximumParameters) {
    throw Error(ErrorCode::InvalidModel, "the model would have " +
                                             std::to_string(this->parameterCount) +
                                             " parameters; at most 2^31 - 1 are possible");
  }
}

} // namespace inr
