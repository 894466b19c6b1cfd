// SPDX-License-Identifier: BSD-3-Clause
//
// Orthogonalised momentum for layers of the network: what Core's OrthogonalUpdate.h does, to
// rounding. A block for a layer, whose warps share the tiles of each product: layers are few and
// small, and products that depend on each other would be some fifteen launches.
#pragma once

#include "CUDA/Training/Kernels/TrainNetwork.h"
#include "Core/Training/Descent/NewtonSchulz.h"

#include <cmath>
#include <cstdint>
#include <cstring>

namespace inr {
namespace cuda {

/// A layer's matrix in memory, with its shorter side across.
struct TallLayer
{
  INR_HOST_DEVICE TallLayer(int rows, int columns)
      : transposed(rows < columns), height(transposed ? columns : rows),
        width(transposed ? rows : columns)
  {}

  /// Of the k-th weight of the layer, which has so many columns.
  INR_HOST_DEVICE std::int64_t at(std::int64_t k, int columns) const
  {
    return this->transposed ? k % columns * this->width + k / columns : k;
  }
  INR_HOST_DEVICE std::int64_t size() const { return std::int64_t{this->height} * this->width; }
  INR_HOST_DEVICE std::int64_t workspace() const ///< floats
  {
    return 2 * (this->size() + std::int64_t{this->width} * this->width);
  }

  bool transposed;
  int height, width;
};

struct TrainUpdateLayers
{
  static constexpr int Threads = 256;
  static constexpr std::int64_t SharedBytes = Threads / WarpSize * ProductShared * sizeof(float);

  const TrainLayer* layers;
  int count;      ///< of those that are updated, from the first on
  float* weights; ///< all of the network
  float* momentum;
  const float* gradients; ///< of all weights
  float kept;             ///< share of the momentum
  float rate;
  float* workspace;
  std::int64_t workspaceOfLayer; ///< floats, as many as the largest takes

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    for (int l = block.index(); l < this->count; l += block.count()) {
      this->update(block, this->layers[l], this->workspace + l * this->workspaceOfLayer);
    }
  }

private:
  template <class Block>
  INR_HOST_DEVICE void update(Block& block, const TrainLayer& layer, float* x) const
  {
    const TallLayer shape(layer.rows, layer.columns);
    float* next = x + shape.size();
    float* const gram = next + shape.size();
    float* const polynomial = gram + std::int64_t{shape.width} * shape.width;
    if (!this->moveMomentum(block, layer, x) || !normalise(block, x, shape.size())) {
      return;
    }
    for (int round = 0; round < NewtonSchulzRounds; ++round) {
      multiply(block, shape, x, gram, polynomial, next);
      float* const last = x;
      x = next;
      next = last;
    }
    block.threads([&](int thread) {
      for (std::int64_t k = thread; k < shape.size(); k += Threads) {
        this->weights[layer.firstWeight + k] -= this->rate * x[shape.at(k, layer.columns)];
      }
    });
  }

  /// Enters the gradient into the momentum; x = where the step goes. False, to all threads: there
  /// is no gradient.
  template <class Block>
  INR_HOST_DEVICE bool moveMomentum(Block& block, const TrainLayer& layer, float* x) const
  {
    const TallLayer shape(layer.rows, layer.columns);
    auto* const shared = reinterpret_cast<std::uint32_t*>(block.shared());
    block.threads([&](int thread) {
      std::uint32_t any = 0;
      for (std::int64_t k = thread; k < shape.size(); k += Threads) {
        const float gradient = this->gradients[layer.firstWeight + k];
        any |= MagnitudeBits(gradient);
        const float added = (1.0f - this->kept) * gradient;
        float& moved = this->momentum[layer.firstWeight + k];
        moved = this->kept * moved + added;
        x[shape.at(k, layer.columns)] = this->kept * moved + added;
      }
      shared[thread] = any;
    });
    std::uint32_t* const ofAll = shared + Threads; // apart from what threads write next
    block.threads([&](int thread) {
      if (thread == 0) {
        *ofAll = 0;
        for (int k = 0; k < Threads; ++k) {
          *ofAll |= shared[k];
        }
      }
    });
    return *ofAll != 0;
  }

  /// Divides by the largest element, then by the square root of the sum of squares. False, to all
  /// threads: all is zero, and nothing is done.
  template <class Block>
  INR_HOST_DEVICE static bool normalise(Block& block, float* x, std::int64_t size)
  {
    auto* const shared = reinterpret_cast<float*>(block.shared());
    float* const largest = shared + Threads; // apart from what threads write next
    float* const scale = largest + 1;
    block.threads([&](int thread) {
      std::uint32_t bits = 0;
      for (std::int64_t k = thread; k < size; k += Threads) {
        const std::uint32_t other = MagnitudeBits(x[k]);
        bits = bits < other ? other : bits;
      }
      memcpy(shared + thread, &bits, sizeof(bits));
    });
    block.threads([&](int thread) {
      for (int k = 0; k < Threads && thread == 0; ++k) {
        *largest =
            k == 0 || MagnitudeBits(*largest) < MagnitudeBits(shared[k]) ? shared[k] : *largest;
      }
    });
    if (MagnitudeBits(*largest) == 0) {
      return false;
    }
    block.threads([&](int thread) {
      float squares = 0.0f;
      for (std::int64_t k = thread; k < size; k += Threads) {
        const float value = x[k] / *largest;
        x[k] = fabsf(value) < NewtonSchulzNegligible ? 0.0f : value;
        squares += x[k] * x[k];
      }
      shared[thread] = squares;
    });
    block.threads([&](int thread) {
      float squares = 0.0f;
      for (int k = 0; k < Threads && thread == 0; ++k) {
        squares += shared[k];
      }
      if (thread == 0) {
        *scale = 1.0f / sqrtf(squares);
      }
    });
    block.threads([&](int thread) {
      for (std::int64_t k = thread; k < size; k += Threads) {
        x[k] *= *scale;
      }
    });
    return true;
  }

  /// store(i, j, sum of left(i, k) * right(j, k) over k < depth) for i < rows, j < columns.
  template <bool LeftAlongDepth, class Block, class Left, class Right, class Store>
  INR_HOST_DEVICE static void product(Block& block, int rows, int columns, int depth,
                                      const Left& left, const Right& right, const Store& store)
  {
    block.warps([&](auto& warp) {
      float* const shared = reinterpret_cast<float*>(block.shared()) + warp.index() * ProductShared;
      const std::int64_t across = TilesOf(columns);
      const std::int64_t tiles = TilesOf(rows) * across;
      for (std::int64_t t = warp.index(); t < tiles; t += Threads / WarpSize) {
        const auto row = static_cast<int>(t / across) * ProductTile;
        const auto column = static_cast<int>(t % across) * ProductTile;
        MultiplyTile<LeftAlongDepth, false>(
            warp, shared, TilePart(rows, row), TilePart(columns, column), depth,
            [&](int i, std::int64_t k) { return left(row + i, k); },
            [&](int j, std::int64_t k) { return right(column + j, k); },
            [&](int, int i, int j, float sum) { store(row + i, column + j, sum); });
      }
    });
  }

  /// next = X (aI + bA + cA^2), A = X^T X.
  template <class Block>
  INR_HOST_DEVICE static void multiply(Block& block, const TallLayer& shape, const float* x,
                                       float* gram, float* polynomial, float* next)
  {
    const std::int64_t width = shape.width;
    const auto ofX = [&](int i, std::int64_t k) { return x[k * width + i]; };
    product<false>(block, shape.width, shape.width, shape.height, ofX, ofX,
                   [&](int i, int j, float sum) { gram[i * width + j] = sum; });
    const auto rowOfGram = [&](int i, std::int64_t k) { return gram[i * width + k]; };
    const auto ofGram = [&](int j, std::int64_t k) { return gram[k * width + j]; };
    product<true>(block, shape.width, shape.width, shape.width, rowOfGram, ofGram,
                  [&](int i, int j, float sum) {
                    const float linear = i == j ? NewtonSchulzA : 0.0f;
                    polynomial[i * width + j] =
                        NewtonSchulzB * gram[i * width + j] + NewtonSchulzC * sum + linear;
                  });
    product<true>(
        block, shape.height, shape.width, shape.width,
        [&](int i, std::int64_t k) { return x[i * width + k]; },
        [&](int j, std::int64_t k) { return polynomial[k * width + j]; },
        [&](int i, int j, float sum) { next[i * width + j] = sum; });
  }
};

} // namespace cuda
} // namespace inr
