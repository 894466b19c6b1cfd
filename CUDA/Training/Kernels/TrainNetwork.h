// SPDX-License-Identifier: BSD-3-Clause
//
// A mini-batch through the network and back, in float32. Each warp takes 32 samples from the first
// layer to the last and back to the encoded features; what a layer makes of them stays in global
// memory, which for usual networks means in the second-level cache. Then warps add up the weights'
// gradients, a tile of weights for a shard of the samples each.
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "CUDA/Inference/Kernels/Activate.h"
#include "CUDA/Training/Kernels/WarpProducts.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace inr {
namespace cuda {

/// A layer and what it makes of samples. A number per sample each: row r of a matrix begins at
/// r * stride.
struct TrainLayer
{
  const float* weights; ///< row-major, rows are outputs
  int rows;
  int columns;              ///< weights from one row to the next
  int used;                 ///< columns that have an input
  std::int64_t firstWeight; ///< in the vector of all weights
  Activation activation;
  const float* input; ///< `used` rows
  std::int64_t inputStride;
  float* before; ///< the activation; `rows` rows, or null where the slope does not need it
  float* after;
  float* delta;      ///< d loss / d after, then d before
  float* inputDelta; ///< d loss / d input, with inputStride
};

/// Samples that go through the network together.
struct TrainPiece
{
  const TrainLayer* layers;
  int layerCount;
  std::int64_t stride; ///< of what layers make
  std::int64_t first;  ///< sample, of those of the inputs of the first layer
  std::int64_t count;
};

/// The magnitude as an integer that is larger for larger ones, and largest for NaNs.
INR_HOST_DEVICE inline std::uint32_t MagnitudeBits(float value)
{
  std::uint32_t bits = 0;
  memcpy(&bits, &value, sizeof(bits));
  return bits & 0x7fffffffu;
}

/// Of a tile of 32 samples: the first one's place in the rows of the first layer's input, and in
/// those of other layers.
struct SampleTile
{
  std::int64_t whole;
  std::int64_t own;
  int count;
};

INR_HOST_DEVICE inline int TilePart(int size, int first)
{
  return size - first < ProductTile ? size - first : ProductTile;
}

struct TrainNetwork
{
  static constexpr int Threads = 128;
  static constexpr std::int64_t SharedBytes = Threads / WarpSize * ProductShared * sizeof(float);

  TrainPiece piece;
  const float* targets;   ///< of the whole batch; NaN = carries no gradient
  float gradientScale;    ///< 1 / (samples in the mini-batch)
  double* losses;         ///< of each 32 samples of the whole batch
  std::uint32_t* largest; ///< becomes MagnitudeBits of the largest d loss / d encoded feature

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.warps([&](auto& warp) {
      constexpr int warps = Threads / WarpSize;
      float* const shared = reinterpret_cast<float*>(block.shared()) + warp.index() * ProductShared;
      const std::int64_t tiles = TilesOf(this->piece.count);
      const std::int64_t step = std::int64_t{block.count()} * warps;
      for (std::int64_t t = std::int64_t{block.index()} * warps + warp.index(); t < tiles;
           t += step) {
        const std::int64_t left = this->piece.count - t * ProductTile;
        const SampleTile tile{this->piece.first + t * ProductTile, t * ProductTile,
                              static_cast<int>(left < ProductTile ? left : ProductTile)};
        for (int l = 0; l < this->piece.layerCount; ++l) {
          this->forward(warp, shared, l, tile);
        }
        this->lose(warp, shared, tile);
        for (int l = this->piece.layerCount - 1; l >= 0; --l) {
          this->backward(warp, shared, l, tile);
        }
      }
    });
  }

private:
  /// Where a layer's input of the tile begins.
  INR_HOST_DEVICE static std::int64_t inputOf(int layer, const SampleTile& tile)
  {
    return layer == 0 ? tile.whole : tile.own;
  }

  template <class Warp>
  INR_HOST_DEVICE void forward(Warp& warp, float* shared, int l, const SampleTile& tile) const
  {
    const TrainLayer& layer = this->piece.layers[l];
    const float* const input = layer.input + inputOf(l, tile);
    for (int row = 0; row < layer.rows; row += ProductTile) {
      const float* const weights = layer.weights + std::int64_t{row} * layer.columns;
      const auto left = [&](int i, std::int64_t k) {
        return weights[std::int64_t{i} * layer.columns + k];
      };
      const auto right = [&](int j, std::int64_t k) { return input[k * layer.inputStride + j]; };
      const auto store = [&](int, int i, int j, float sum) {
        const std::int64_t at = (row + i) * this->piece.stride + tile.own + j;
        if (layer.before != nullptr) {
          layer.before[at] = sum;
        }
        layer.after[at] = Activate(layer.activation, sum);
      };
      MultiplyTile<true, false>(warp, shared, TilePart(layer.rows, row), tile.count, layer.used,
                                left, right, store);
    }
  }

  /// d (output - target)^2 / d output, and the sum of the losses.
  template <class Warp>
  INR_HOST_DEVICE void lose(Warp& warp, float* shared, const SampleTile& tile) const
  {
    const TrainLayer& last = this->piece.layers[this->piece.layerCount - 1];
    auto* const squares = reinterpret_cast<double*>(shared);
    warp.exchange([&](int lane) {
      squares[lane] = 0.0;
      if (lane >= tile.count) {
        return;
      }
      const float target = this->targets[tile.whole + lane];
      const float residual = last.after[tile.own + lane] - target;
      // A NaN target carries no gradient; a NaN output makes the loss one, which ends the training.
      const bool known = target == target;
      squares[lane] = known ? static_cast<double>(residual) * static_cast<double>(residual) : 0.0;
      last.delta[tile.own + lane] = known ? 2.0f * residual * this->gradientScale : 0.0f;
    });
    warp.lanes([&](int lane) {
      if (lane == 0) {
        double sum = 0.0;
        for (int k = 0; k < tile.count; ++k) {
          sum += squares[k];
        }
        this->losses[tile.whole / ProductTile] = sum;
      }
    });
  }

  template <class Warp>
  INR_HOST_DEVICE void backward(Warp& warp, float* shared, int l, const SampleTile& tile) const
  {
    const TrainLayer& layer = this->piece.layers[l];
    warp.exchange([&](int lane) { // the sums of the loss are done, too
      for (int row = 0; row < layer.rows && lane < tile.count; ++row) {
        const std::int64_t at = row * this->piece.stride + tile.own + lane;
        const float before = layer.before != nullptr ? layer.before[at] : 0.0f;
        layer.delta[at] *= ActivationSlope(layer.activation, before, layer.after[at]);
      }
    });
    typename Warp::template PerLane<std::uint32_t> largestOf;
    warp.lanes([&](int lane) { largestOf[lane] = 0; });
    for (int column = 0; column < layer.used; column += ProductTile) {
      const auto left = [&](int i, std::int64_t k) {
        return layer.weights[k * layer.columns + column + i];
      };
      const auto right = [&](int j, std::int64_t k) {
        return layer.delta[k * this->piece.stride + tile.own + j];
      };
      const auto store = [&](int lane, int i, int j, float sum) {
        layer.inputDelta[(column + i) * layer.inputStride + inputOf(l, tile) + j] = sum;
        const std::uint32_t bits = MagnitudeBits(sum);
        largestOf[lane] = bits > largestOf[lane] ? bits : largestOf[lane];
      };
      MultiplyTile<false, false>(warp, shared, TilePart(layer.used, column), tile.count, layer.rows,
                                 left, right, store);
    }
    if (l == 0) {
      this->keepLargest(warp, shared, largestOf);
    }
  }

  template <class Warp>
  INR_HOST_DEVICE void
  keepLargest(Warp& warp, float* shared,
              const typename Warp::template PerLane<std::uint32_t>& largestOf) const
  {
    auto* const numbers = reinterpret_cast<std::uint32_t*>(shared);
    warp.exchange([&](int lane) { numbers[lane] = largestOf[lane]; });
    warp.exchange([&](int lane) {
      if (lane == 0) {
        std::uint32_t all = 0;
        for (int k = 0; k < WarpSize; ++k) {
          all = numbers[k] > all ? numbers[k] : all;
        }
        AtomicMax(*this->largest, all);
      }
    });
  }
};

/// d loss / d weight, for each shard of `shardSize` samples of the piece on its own: the sums
/// depend on no order but that of samples and pieces.
struct TrainWeights
{
  static constexpr int Threads = 128;
  static constexpr std::int64_t SharedBytes = Threads / WarpSize * ProductShared * sizeof(float);

  TrainPiece piece;
  std::int64_t shardSize;
  std::int64_t weightCount;
  float* gradients; ///< weightCount of the first shard, and so on
  bool adds;        ///< to those of an earlier piece

  INR_HOST_DEVICE static std::int64_t tilesOf(const TrainLayer& layer)
  {
    return TilesOf(layer.rows) * TilesOf(layer.used);
  }

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.warps([&](auto& warp) {
      constexpr int warps = Threads / WarpSize;
      float* const shared = reinterpret_cast<float*>(block.shared()) + warp.index() * ProductShared;
      std::int64_t tiles = 0;
      for (int l = 0; l < this->piece.layerCount; ++l) {
        tiles += tilesOf(this->piece.layers[l]);
      }
      const std::int64_t shards = (this->piece.count + this->shardSize - 1) / this->shardSize;
      const std::int64_t step = std::int64_t{block.count()} * warps;
      for (std::int64_t item = std::int64_t{block.index()} * warps + warp.index();
           item < shards * tiles; item += step) {
        this->addUp(warp, shared, item / tiles, item % tiles);
      }
    });
  }

private:
  template <class Warp>
  INR_HOST_DEVICE void addUp(Warp& warp, float* shared, std::int64_t shard, std::int64_t tile) const
  {
    int l = 0;
    while (tile >= tilesOf(this->piece.layers[l])) {
      tile -= tilesOf(this->piece.layers[l++]);
    }
    const TrainLayer& layer = this->piece.layers[l];
    const std::int64_t across = TilesOf(layer.used);
    const auto row = static_cast<int>(tile / across) * ProductTile;
    const auto column = static_cast<int>(tile % across) * ProductTile;
    const std::int64_t first = shard * this->shardSize;
    const std::int64_t rest = this->piece.count - first;
    const float* const delta = layer.delta + first;
    const float* const input = layer.input + (l == 0 ? this->piece.first : 0) + first;
    const auto left = [&](int i, std::int64_t k) {
      return delta[(row + i) * this->piece.stride + k];
    };
    const auto right = [&](int j, std::int64_t k) {
      return input[(column + j) * layer.inputStride + k];
    };
    float* const gradient = this->gradients + shard * this->weightCount + layer.firstWeight;
    const auto store = [&](int, int i, int j, float sum) {
      float& place = gradient[std::int64_t{row + i} * layer.columns + column + j];
      place = this->adds ? place + sum : sum;
    };
    MultiplyTile<true, true>(warp, shared, TilePart(layer.rows, row), TilePart(layer.used, column),
                             rest < this->shardSize ? rest : this->shardSize, left, right, store);
  }
};

} // namespace cuda
} // namespace inr
