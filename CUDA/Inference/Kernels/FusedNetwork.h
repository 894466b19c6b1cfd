// SPDX-License-Identifier: BSD-3-Clause
//
// The network for tiles of 16 samples by one warp, without leaving its registers: several tiles
// that share each weight that is read, where there is room.
#pragma once

#include "CUDA/Device/Kernels/Block.h"
#include "CUDA/Inference/Kernels/Numbers.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Neurons of a hidden layer that a warp's registers hold.
constexpr int MostFusedNeurons = 128;

/// Weights in tiles, in the order in which they are used: layer by layer, the last one of a single
/// column of tiles; within a layer by tile of inputs, then by tile of outputs, then, of float32
/// numbers, by half of these; 32 shares each.
template <class Numbers> struct FusedNetwork
{
  const typename Numbers::Weight* weights;
  std::int64_t weightShares; ///< of all layers
  bool hasSecond;            ///< a layer's tiles are followed by those of its weights' second parts
  int inputTiles;            ///< of the first layer
  int hiddenLayers;
  Activation activation;
  Activation outputActivation;
};

/// Reads the weights of one tile of inputs, and calls multiply(h, n, share, part) for each tile of
/// samples and of outputs, and each share of its weights.
template <class Numbers, int OutputTiles, int Halves, class Warp, class Multiply>
INR_HOST_DEVICE inline void ForEachShare(Warp& warp, const typename Numbers::Weight* tiles,
                                         const Multiply& multiply)
{
  INR_UNROLL
  for (int n = 0; n < OutputTiles; ++n) {
    INR_UNROLL
    for (int part = 0; part < Numbers::WeightShares; ++part) {
      typename Warp::template PerLane<typename Numbers::Weight> share;
      warp.lanes([&](int lane) {
        share[lane] = tiles[(n * Numbers::WeightShares + part) * WarpSize + lane];
      });
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        multiply(h, n, share, part);
      }
    }
  }
}

/// Sums of one layer for `Halves` tiles of samples. inputs.forEachTile(tiles, function) calls
/// function(k, ofHalf), and ofHalf(h) is tile k of the inputs of tile h of samples: a PerLane.
/// Returns where the next layer's weights begin.
template <class Numbers, int OutputTiles, int Halves, class Warp, class Inputs>
INR_HOST_DEVICE inline const typename Numbers::Weight*
MultiplyLayer(Warp& warp, const FusedNetwork<Numbers>& network,
              const typename Numbers::Weight* weights, int inputTiles, Inputs& inputs,
              typename Warp::template PerLane<SumShare> (&sums)[Halves][OutputTiles])
{
  INR_UNROLL
  for (int h = 0; h < Halves; ++h) {
    INR_UNROLL
    for (int n = 0; n < OutputTiles; ++n) {
      warp.lanes([&](int lane) { sums[h][n][lane] = SumShare{}; });
    }
  }
  constexpr int shares = OutputTiles * Numbers::WeightShares * WarpSize; // of a tile of inputs
  const int all = inputTiles * shares;
  inputs.forEachTile(inputTiles, [&](int k, const auto& ofHalf) {
    const auto* const tiles = weights + k * shares;
    if constexpr (Numbers::HasSecondWeights) {
      if (network.hasSecond) {
        ForEachShare<Numbers, OutputTiles, Halves>(
            warp, tiles + all, [&](int h, int n, const auto& share, int part) {
              warp.multiplyAddFirst(ofHalf(h), share, part, sums[h][n]);
            });
      }
    }
    ForEachShare<Numbers, OutputTiles, Halves>(
        warp, tiles, [&](int h, int n, const auto& share, int part) {
          if constexpr (Numbers::WeightShares > 1) {
            warp.multiplyAdd(ofHalf(h), share, part, sums[h][n]);
          } else {
            warp.multiplyAdd(ofHalf(h), share, sums[h][n]);
          }
        });
  });
  return weights + (network.hasSecond ? 2 : 1) * all;
}

/// Inputs that lie encoded in shared memory: 16 * Halves rows.
template <class Numbers, int Halves, class Warp> class StagedInputs
{
public:
  INR_HOST_DEVICE StagedInputs(Warp& warp, const typename Numbers::Staged* rows, int stride)
      : Self(warp), Rows(rows), Stride(stride)
  {}

  template <class Function>
  INR_HOST_DEVICE void forEachTile(int tiles, const Function& function) const
  {
    for (int k = 0; k < tiles; ++k) {
      typename Warp::template PerLane<typename Numbers::Input> shares[Halves];
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        const auto* const from = this->Rows + h * TileSize * this->Stride + k * TileSize;
        this->Self.lanes([&](int lane) {
          shares[h][lane] = Numbers::inputOf(Numbers::load(from, this->Stride, lane));
        });
      }
      function(
          k, [&](int h) -> const auto& { return shares[h]; });
    }
  }

private:
  Warp& Self;
  const typename Numbers::Staged* Rows;
  int Stride;
};

/// Inputs that are a layer's results: kept in registers.
template <class Numbers, int Tiles, int Halves, class Warp> class KeptInputs
{
public:
  INR_HOST_DEVICE explicit KeptInputs(Warp& warp) : Self(warp) {}

  INR_HOST_DEVICE void take(Activation activation,
                            const typename Warp::template PerLane<SumShare> (&sums)[Halves][Tiles])
  {
    WithActivation(activation, [&](const auto& activate) {
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        INR_UNROLL
        for (int n = 0; n < Tiles; ++n) {
          this->Self.lanes([&](int lane) {
            this->Results[h][n][lane] = Numbers::activate(activate, sums[h][n][lane]);
          });
        }
      }
    });
    this->Self.exchange([](int) {}); // lanes part in slow activations, and multiply together
  }

  template <class Function> INR_HOST_DEVICE void forEachTile(int, const Function& function) const
  {
    INR_UNROLL
    for (int k = 0; k < Tiles; ++k) {
      typename Warp::template PerLane<typename Numbers::Input> shares[Halves];
      INR_UNROLL
      for (int h = 0; h < Halves; ++h) {
        this->Self.lanes(
            [&](int lane) { shares[h][lane] = Numbers::inputOf(this->Results[h][k][lane]); });
      }
      function(
          k, [&](int h) -> const auto& { return shares[h]; });
    }
  }

private:
  Warp& Self;
  typename Warp::template PerLane<typename Numbers::Kept> Results[Halves][Tiles];
};

/// Outputs of 16 * Halves samples to results[0 ...], in shared memory.
template <class Numbers, int Halves, class Warp, class Inputs>
INR_HOST_DEVICE inline void RunLastLayer(Warp& warp, const FusedNetwork<Numbers>& network,
                                         const typename Numbers::Weight* weights, int inputTiles,
                                         Inputs& inputs, float* results)
{
  typename Warp::template PerLane<SumShare> sums[Halves][1];
  MultiplyLayer<Numbers, 1, Halves>(warp, network, weights, inputTiles, inputs, sums);
  WithActivation(network.outputActivation, [&](const auto& activate) {
    warp.exchange([&](int lane) {
      if (ColumnOf(lane) == 0) { // output 0
        INR_UNROLL
        for (int h = 0; h < Halves; ++h) {
          INR_UNROLL
          for (int part = 0; part < 2; ++part) {
            results[h * TileSize + RowOf(lane) + 8 * part] =
                Numbers::output(activate, sums[h][0][lane].values[2 * part]);
          }
        }
      }
    });
  });
}

/// Outputs of 16 * Halves samples whose encoding is `inputs`, to results[0 ...], in shared memory:
/// NaN where a number left the range of `Numbers` on its way. `Tiles`: of a hidden layer's neurons.
template <class Numbers, int Tiles, int Halves, class Warp, class Inputs>
INR_HOST_DEVICE inline void RunNetwork(Warp& warp, const FusedNetwork<Numbers>& network,
                                       Inputs& inputs, float* results)
{
  const auto* weights = network.weights;
  if (network.hiddenLayers == 0) {
    RunLastLayer<Numbers, Halves>(warp, network, weights, network.inputTiles, inputs, results);
    return;
  }
  typename Warp::template PerLane<SumShare> sums[Halves][Tiles];
  KeptInputs<Numbers, Tiles, Halves, Warp> kept(warp);
  weights = MultiplyLayer<Numbers, Tiles, Halves>(warp, network, weights, network.inputTiles,
                                                  inputs, sums);
  kept.take(network.activation, sums);
  for (int layer = 1; layer < network.hiddenLayers; ++layer) {
    weights = MultiplyLayer<Numbers, Tiles, Halves>(warp, network, weights, Tiles, kept, sums);
    kept.take(network.activation, sums);
  }
  RunLastLayer<Numbers, Halves>(warp, network, weights, Tiles, kept, results);
}

} // namespace cuda
} // namespace inr
