// SPDX-License-Identifier: BSD-3-Clause
//
// The network for 32 encoded samples by one warp, without leaving its registers: two tiles of 16
// samples that share each weight that is read, or one after the other where layers are wide.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Inference/Kernels/Activate.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Neurons of a hidden layer that a warp's registers hold.
constexpr int MostFusedNeurons = 128;

/// Weights in tiles, in the order in which they are used: layer by layer, the last one of a single
/// column of tiles; within a layer by tile of inputs, then by tile of outputs; 32 shares each.
struct FusedNetwork
{
  const WeightShare* weights;
  std::int64_t weightShares; ///< 32 per tile
  int inputTiles;            ///< of the first layer
  int hiddenLayers;
  Activation activation;
  Activation outputActivation;
};

/// Sums of one layer for `Halves` tiles of samples; inputs(h, k) is the share of a lane of tile k
/// of inputs: a PerLane. Returns where the next layer's weights begin.
template <int OutputTiles, int Halves, class Warp, class Inputs>
INR_HOST_DEVICE inline const WeightShare*
MultiplyLayer(Warp& warp, const WeightShare* weights, int inputTiles, Inputs& inputs,
              typename Warp::template PerLane<SumShare> (&sums)[Halves][OutputTiles])
{
  INR_UNROLL
  for (int h = 0; h < Halves; ++h) {
    INR_UNROLL
    for (int n = 0; n < OutputTiles; ++n) {
      warp.lanes([&](int lane) { sums[h][n][lane] = SumShare{}; });
    }
  }
  inputs.forEachTile(inputTiles, [&](int k, const auto& ofHalf) {
    const WeightShare* const tiles = weights + k * OutputTiles * WarpSize;
    INR_UNROLL
    for (int n = 0; n < OutputTiles; ++n) {
      typename Warp::template PerLane<WeightShare> share;
      warp.lanes([&](int lane) { share[lane] = tiles[n * WarpSize + lane]; });
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        warp.multiplyAdd(ofHalf(h), share, sums[h][n]);
      }
    }
  });
  return weights + inputTiles * OutputTiles * WarpSize;
}

/// Inputs that lie encoded in shared memory: 16 * Halves rows.
template <int Halves, class Warp> class StagedInputs
{
public:
  INR_HOST_DEVICE StagedInputs(Warp& warp, const HalfBits* rows, int stride)
      : Self(warp), Rows(rows), Stride(stride)
  {}

  template <class Function>
  INR_HOST_DEVICE void forEachTile(int tiles, const Function& function) const
  {
    for (int k = 0; k < tiles; ++k) {
      typename Warp::template PerLane<InputShare> shares[Halves];
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        const HalfBits* const from = this->Rows + h * TileSize * this->Stride + k * TileSize;
        this->Self.lanes([&](int lane) { shares[h][lane] = LoadInputs(from, this->Stride, lane); });
      }
      function(
          k, [&](int h) -> const auto& { return shares[h]; });
    }
  }

private:
  Warp& Self;
  const HalfBits* Rows;
  int Stride;
};

/// Inputs that are a layer's results: kept in registers.
template <int Tiles, int Halves, class Warp> class KeptInputs
{
public:
  /// Activated sums, as halves.
  INR_HOST_DEVICE void take(Warp& warp, Activation activation,
                            const typename Warp::template PerLane<SumShare> (&sums)[Halves][Tiles])
  {
    INR_UNROLL
    for (int h = 0; h < Halves; ++h) {
      INR_UNROLL
      for (int n = 0; n < Tiles; ++n) {
        warp.lanes([&](int lane) {
          INR_UNROLL
          for (int r = 0; r < 4; ++r) {
            const float* const pair = sums[h][n][lane].values + 2 * r;
            this->Shares[h][n][lane].pairs[r] =
                PackHalves(Activate(activation, pair[0]), Activate(activation, pair[1]));
          }
        });
      }
    }
  }

  template <class Function> INR_HOST_DEVICE void forEachTile(int, const Function& function) const
  {
    INR_UNROLL
    for (int k = 0; k < Tiles; ++k) {
      function(
          k, [&](int h) -> const auto& { return this->Shares[h][k]; });
    }
  }

private:
  typename Warp::template PerLane<InputShare> Shares[Halves][Tiles];
};

/// Outputs of 16 * Halves samples to results[0 ...], in shared memory.
template <int Halves, class Warp, class Inputs>
INR_HOST_DEVICE inline void RunLastLayer(Warp& warp, const FusedNetwork& network,
                                         const WeightShare* weights, int inputTiles, Inputs& inputs,
                                         float* results)
{
  typename Warp::template PerLane<SumShare> sums[Halves][1];
  MultiplyLayer<1, Halves>(warp, weights, inputTiles, inputs, sums);
  warp.exchange([&](int lane) {
    if (ColumnOf(lane) == 0) { // output 0
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        INR_UNROLL
        for (int part = 0; part < 2; ++part) {
          results[h * TileSize + RowOf(lane) + 8 * part] =
              Activate(network.outputActivation, sums[h][0][lane].values[2 * part]);
        }
      }
    }
  });
}

template <int Tiles, int Halves, class Warp>
INR_HOST_DEVICE inline void RunHalves(Warp& warp, const FusedNetwork& network, const HalfBits* rows,
                                      int stride, float* results)
{
  StagedInputs<Halves, Warp> staged(warp, rows, stride);
  const WeightShare* weights = network.weights;
  if (network.hiddenLayers == 0) {
    RunLastLayer<Halves>(warp, network, weights, network.inputTiles, staged, results);
    return;
  }
  typename Warp::template PerLane<SumShare> sums[Halves][Tiles];
  KeptInputs<Tiles, Halves, Warp> kept;
  weights = MultiplyLayer<Tiles, Halves>(warp, weights, network.inputTiles, staged, sums);
  kept.take(warp, network.activation, sums);
  for (int layer = 1; layer < network.hiddenLayers; ++layer) {
    weights = MultiplyLayer<Tiles, Halves>(warp, weights, Tiles, kept, sums);
    kept.take(warp, network.activation, sums);
  }
  RunLastLayer<Halves>(warp, network, weights, Tiles, kept, results);
}

/// Outputs of a warp's 32 samples, NaN where a number left the range of halves on its way. Row s of
/// `rows` is sample s, encoded: network.inputTiles * 16 halves. Both in shared memory. `Tiles`: of
/// a hidden layer's neurons.
template <int Tiles, class Warp>
INR_HOST_DEVICE inline void RunNetwork(Warp& warp, const FusedNetwork& network,
                                       const HalfBits* rows, int stride, float* results)
{
  constexpr int halves = Tiles * TileSize < MostFusedNeurons ? 2 : 1;
  for (int first = 0; first < 2; first += halves) {
    RunHalves<Tiles, halves>(warp, network, rows + first * TileSize * stride, stride,
                             results + first * TileSize);
  }
}

} // namespace cuda
} // namespace inr
