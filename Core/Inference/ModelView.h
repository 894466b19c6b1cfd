// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/CacheLine.h"
#include "Core/Inference/InferencePrecision.h"
#include "Core/Model/Description.h"

#include <cstdint>
#include <vector>

namespace inr {

/// How a corner's running index is brought into [0, entries).
enum class IndexWrap {
  Mask,     ///< entries is a power of two
  Subtract, ///< index < 2 * entries is known
  Modulo
};

/// One grid level, ready for a kernel. Plain data: this header is included by code built for one
/// instruction set and must define no function.
struct LevelView
{
  float scale;
  std::uint32_t strides[3]; ///< of the running index; 0 where upstream's loop has ended
  std::uint32_t primes[3];  ///< of the hash
  std::uint32_t entries;
  IndexWrap wrap;
  bool hashed;
  bool randomHash;      ///< HashFunction::Rng, which is no XOR of products
  std::uint64_t offset; ///< of the level's first feature from the grid's start, in parameters
};

/// Rows of a weight matrix that lie side by side in a panel.
constexpr int PanelRows = 8;

/// In which order and as what kernels read weights; see PackedNetwork.
enum class WeightLayout { Panels, Pairs, Tiles, SplitTiles };

struct LayerView
{
  const float* weights; ///< row-major, rows are outputs
  int rows;             ///< the last layer's padding rows are left out: 1
  int columns;
  /// The weights in the order in which inference reads them, or null: see PackedNetwork.
  const float* panels;
  const std::uint32_t* pairs;
};

/// A model's description and parameters as the kernels want them.
struct ModelView
{
  const LevelView* levels;
  int levelCount;
  int features;
  GridInterpolation interpolation;
  const float* grid; ///< features of all levels
  const LayerView* layers;
  int layerCount;
  Activation activation;
  Activation outputActivation;
  int encodedWidth;
  int inputWidth;
  int widest; ///< largest number of columns or rows of any layer
};

/// HashFunction::Rng of a corner; a function of its own so that it is built once, for any
/// processor.
std::uint32_t RandomHashOfCorner(std::uint32_t x, std::uint32_t y, std::uint32_t z);

/// Owns the tables a ModelView points into, but not the parameters.
class ModelViewStorage
{
public:
  /// `parameters` must hold Layout(description).parameterCount values and outlive this.
  ModelViewStorage(const Description& description, const Layout& layout, const float* parameters);
  ModelViewStorage(const ModelViewStorage&) = delete;
  ModelViewStorage& operator=(const ModelViewStorage&) = delete;

  const ModelView& view() const { return this->View; }

private:
  std::vector<LevelView> Levels;
  std::vector<LayerView> Layers;
  ModelView View{};
};

/// A model's weights as a kernel wants them; rows and columns beyond the last are 0. A copy: later
/// changes of the weights are not seen.
///
/// Panels, for float32: weight (r, c) of a layer is element
/// ((r / PanelRows) * columns + c) * PanelRows + r % PanelRows of `panels`.
/// Pairs, for bfloat16: the same of `pairs`, with pairs of columns: in the lower half of an element
/// the weight of the even one, rounded to nearest, in the upper half that of the next.
/// Tiles: pair c of row r is element (r % TileSize) * TileSize + c % TileSize of a tile, and the
/// tile is number (r / TileSize) * tiles + c / TileSize, of `tiles` to a row. A tile's row fills a
/// cache line.
/// SplitTiles: of each tile two, one behind the other: the weights rounded, and what that leaves.
class PackedNetwork
{
public:
  /// What `model` points to, except for its weights, must outlive this.
  explicit PackedNetwork(const ModelView& model, WeightLayout layout = WeightLayout::Panels);
  PackedNetwork(const PackedNetwork&) = delete;
  PackedNetwork& operator=(const PackedNetwork&) = delete;

  /// `model`, with panels or pairs.
  const ModelView& view() const { return this->View; }

private:
  /// Sixteen pairs.
  struct alignas(CacheLineBytes) Line
  {
    std::uint32_t pairs[16];
  };

  static std::vector<Line> TilesOf(const LayerView& layer, std::size_t parts);

  std::vector<std::vector<float>> Panels;
  std::vector<std::vector<std::uint32_t>> Pairs;
  std::vector<std::vector<Line>> Tiles;
  std::vector<LayerView> Layers;
  ModelView View;
};

} // namespace inr
