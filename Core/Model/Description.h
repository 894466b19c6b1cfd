// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

namespace inr {

enum class GridType { Hash, Dense, Tiled };
enum class GridInterpolation { Linear, Smoothstep, Nearest };
enum class HashFunction { CoherentPrime, Prime, ReversedPrime, Rng };

/// How the index of a lattice corner overflows. tiny-cuda-nn before June 2025 (every instantvnr and
/// cINR file) lets the running stride wrap at 2^32, so that very fine levels lose an axis; later
/// versions always hash there. Nothing in upstream's files tells them apart.
enum class HashRule { Wrapping, Exact };

enum class Activation {
  None,
  ReLU,
  LeakyReLU,
  Exponential,
  Sigmoid,
  Sine,
  Squareplus,
  Softplus,
  Tanh
};

/// The multi-resolution grid encoding (Müller et al., "Instant Neural Graphics Primitives",
/// SIGGRAPH 2022), with tiny-cuda-nn's parameters and defaults.
struct GridDescription
{
  GridType type = GridType::Hash;
  GridInterpolation interpolation = GridInterpolation::Linear;
  HashFunction hash = HashFunction::CoherentPrime;
  HashRule rule = HashRule::Wrapping;
  int levels = 16;            ///< 1 to 128
  int features = 2;           ///< per level: 1, 2, 4 or 8
  int log2HashmapSize = 19;   ///< 0 to 30
  int baseResolution = 16;    ///< lattice points per axis on level 0: 1 to 2^20
  float perLevelScale = 2.0f; ///< resolution ratio of neighbouring levels, at least 1

  bool operator==(const GridDescription& other) const
  {
    const auto all = [](const GridDescription& grid) {
      return std::tie(grid.type, grid.interpolation, grid.hash, grid.rule, grid.levels,
                      grid.features, grid.log2HashmapSize, grid.baseResolution, grid.perLevelScale);
    };
    return all(*this) == all(other);
  }
};

/// The multi-layer perceptron: no biases, one output.
struct NetworkDescription
{
  int neurons = 64;     ///< width of a hidden layer: 1 to 1024
  int hiddenLayers = 4; ///< 0 (a single matrix) to 64
  Activation activation = Activation::ReLU;
  Activation outputActivation = Activation::None;
  int alignment = 16; ///< input and output widths are padded to it: 8 or 16

  bool operator==(const NetworkDescription& other) const
  {
    const auto all = [](const NetworkDescription& network) {
      return std::tie(network.neurons, network.hiddenLayers, network.activation,
                      network.outputActivation, network.alignment);
    };
    return all(*this) == all(other);
  }
};

/// What an INR is, without its parameters.
struct Description
{
  GridDescription grid;
  NetworkDescription network;

  bool operator==(const Description& other) const
  {
    return this->grid == other.grid && this->network == other.network;
  }
};

/// One level of the grid in the parameter vector.
struct GridLevel
{
  float scale = 0;              ///< lattice coordinate = u * scale + 0.5
  std::uint32_t resolution = 0; ///< lattice points per axis
  std::uint32_t entries = 0;    ///< table size
  std::uint64_t offset = 0;     ///< first entry, counted in entries from the grid's start
  bool hashed = false;          ///< the corner index is hash(p) % entries
  /// Where not hashed, it is (p.x*stride[0] + p.y*stride[1] + p.z*stride[2] mod 2^32) % entries; an
  /// axis that the hash rule drops has stride 0. See GridIndex.h.
  std::uint32_t stride[3] = {0, 0, 0};
};

/// One weight matrix in the parameter vector: row-major, rows are outputs.
struct LayerShape
{
  int rows = 0;
  int columns = 0;
  std::uint64_t offset = 0; ///< first weight, counted in parameters
};

/// Where everything is in the parameter vector [MLP matrices][grid features]; tiny-cuda-nn's
/// layout. Feature f of entry e on level l is parameter gridOffset + (levels[l].offset +
/// e)*features + f.
struct Layout
{
  /// Throws Error(InvalidModel) for a value outside the ranges documented above, or when the total
  /// exceeds 2^31 - 1 parameters.
  explicit Layout(const Description& description);

  std::vector<GridLevel> levels;
  std::vector<LayerShape> layers;
  int encodedWidth = 0;         ///< levels * features
  int inputWidth = 0;           ///< encodedWidth padded; the padding's inputs are zero
  int outputWidth = 0;          ///< 1 padded; row 0 of the last matrix is the value
  std::uint64_t gridOffset = 0; ///< = number of MLP weights
  std::uint64_t parameterCount = 0;
};

} // namespace inr
