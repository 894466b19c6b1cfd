// SPDX-License-Identifier: BSD-3-Clause
//
// Values at scattered points: fused, and by a thread each.
#pragma once

#include "CUDA/Inference/Kernels/Encode.h"
#include "CUDA/Inference/Kernels/FloatNetwork.h"
#include "CUDA/Inference/Kernels/FusedNetwork.h"
#include "CUDA/Inference/Kernels/FusedShared.h"

namespace inr {
namespace cuda {

/// A model in the memory of whoever runs the kernel.
template <class Numbers> struct FusedModel
{
  GridView<typename Numbers::Feature> grid;
  FusedNetwork<Numbers> network;
};

constexpr int ThreadsPerBlock = 128; ///< of kernels at points
constexpr int WarpsPerBlock = ThreadsPerBlock / WarpSize;

/// Numbers from one encoded row to the next; see LoadInputs.
INR_HOST_DEVICE constexpr int RowStride(int inputTiles) { return inputTiles * TileSize + 8; }

/// The weights, from the copy in shared memory where there is one. A phase.
template <class Block, class Numbers>
INR_HOST_DEVICE inline FusedNetwork<Numbers>
ShareWeights(Block& block, int threads, const FusedNetwork<Numbers>& network, bool keepsWeights)
{
  FusedNetwork<Numbers> shared = network;
  if (keepsWeights) {
    auto* const copy = reinterpret_cast<typename Numbers::Weight*>(block.shared());
    block.threads([&](int thread) {
      for (std::int64_t k = thread; k < network.weightShares; k += threads) {
        copy[k] = network.weights[k];
      }
    });
    shared.weights = copy;
  }
  return shared;
}

/// `Tiles`: of 16 neurons, of a hidden layer.
template <int Tiles, class Numbers> struct FusedPoints
{
  static constexpr int Threads = ThreadsPerBlock;
  /// Else entries that are on their way would take the way through memory once more.
  /// Shared memory holds no more of float32's than two.
  static constexpr int LeastBlocks = Tiles == 4 ? (Numbers::HasSecondWeights ? 2 : 3) : 0;

  FusedModel<Numbers> model;
  FusedShared shared;
  const float* positions; ///< x, y, z; clamped to [0, 1], a NaN is 0
  std::int64_t count;
  float* values;                      ///< NaN where a number left the range of `Numbers`
  const std::uint64_t* end = nullptr; ///< where not null, of so many points instead

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    const std::int64_t count =
        this->end != nullptr ? static_cast<std::int64_t>(*this->end) : this->count;
    const std::int64_t batches = (count + WarpSize - 1) / WarpSize;
    if (std::int64_t{block.index()} * WarpsPerBlock >= batches) {
      return;
    }
    const FusedNetwork<Numbers> network =
        ShareWeights(block, Threads, this->model.network, this->shared.keepsWeights);
    block.warps([&](auto& warp) {
      const std::int64_t first = std::int64_t{block.index()} * WarpsPerBlock + warp.index();
      const std::int64_t step = std::int64_t{block.count()} * WarpsPerBlock;
      for (std::int64_t batch = first; batch < batches; batch += step) {
        this->infer(block.shared(), warp, network, batch * WarpSize, count);
      }
    });
  }

private:
  using Staged = typename Numbers::Staged;

  template <class Warp>
  INR_HOST_DEVICE void infer(unsigned char* memory, Warp& warp,
                             const FusedNetwork<Numbers>& network, std::int64_t first,
                             std::int64_t count) const
  {
    const int stride = RowStride(network.inputTiles);
    Staged* const rows =
        reinterpret_cast<Staged*>(memory + this->shared.rows) + warp.index() * WarpSize * stride;
    float* const results =
        reinterpret_cast<float*>(memory + this->shared.results) + warp.index() * WarpSize;
    warp.exchange([&](int lane) {
      const std::int64_t sample = first + lane < count ? first + lane : count - 1;
      const float* const xyz = this->positions + 3 * sample;
      const Point point{ClampToUnit(xyz[0]), ClampToUnit(xyz[1]), ClampToUnit(xyz[2])};
      this->encode(point, rows + lane * stride);
    });
    constexpr int halves = Numbers::halves(Tiles);
    for (int tile = 0; tile < WarpSize / TileSize; tile += halves) {
      const StagedInputs<Numbers, halves, Warp> inputs(warp, rows + tile * TileSize * stride,
                                                       stride);
      RunNetwork<Numbers, Tiles, halves>(warp, network, inputs, results + tile * TileSize);
    }
    warp.lanes([&](int lane) {
      if (first + lane < count) {
        this->values[first + lane] = results[lane];
      }
    });
  }

  INR_HOST_DEVICE void encode(const Point& point, Staged* row) const
  {
    const auto& grid = this->model.grid;
    WithFeatures(grid.features, [&](auto features) {
      constexpr int count = decltype(features)::value;
      const auto encodeLevel = [&](int l, float(&found)[count]) {
        InterpolateAt(grid, grid.levels[l], point, found);
      };
      EncodeRow<count>(grid.levelCount, encodeLevel, row);
    });
  }
};

/// The same in float32 without tensor cores: slower, for any model and any GPU, and what the fused
/// kernels are judged by.
struct FloatPoints
{
  static constexpr int Threads = ThreadsPerBlock;

  FloatModel model;
  const float* positions; ///< as above
  std::int64_t count;
  float* values;                      ///< NaN where a number left the range of floats
  float* scratch;                     ///< model.scratchPerThread floats for every thread
  const std::uint64_t* end = nullptr; ///< where not null, of so many points instead

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    const std::int64_t count =
        this->end != nullptr ? static_cast<std::int64_t>(*this->end) : this->count;
    block.threads([&](int thread) {
      const ThreadScratch scratch(this->model, this->scratch, block, thread, Threads);
      for (std::int64_t k = scratch.index(); k < count; k += scratch.threads()) {
        const float* const xyz = this->positions + 3 * k;
        const Point point{ClampToUnit(xyz[0]), ClampToUnit(xyz[1]), ClampToUnit(xyz[2])};
        this->values[k] = EvaluateFloat(this->model, point, scratch);
      }
    });
  }
};

} // namespace cuda
} // namespace inr
