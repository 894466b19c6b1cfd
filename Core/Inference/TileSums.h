// SPDX-License-Identifier: BSD-3-Clause
//
// The sums of the network's layers over products of bfloat16 numbers in tile registers; see Lanes.h
// for what may be in here. INR_TILES names the header of the tile unit: ProcessorTiles.h, or an
// imitation.
//
// A tile of weights (16 outputs by 16 pairs of inputs) times one of inputs (16 pairs by 16 samples)
// adds to one of sums (16 outputs by 16 samples). For each sum, the unit adds up the products of
// the pairs' lower halves by themselves and those of their upper halves by themselves, one after
// the other, then both to what was there; each is a float32 sum, rounded to nearest, and what is
// below 2^-126 is zero (TDPBF16PS in Intel's manual). So a sum over the columns comes about in the
// same order whatever the other samples are, but in another one than in BFloat16Sums.h: values of
// the two differ by rounding.
#pragma once

#include "Core/Inference/Activations.h"
#include "Core/Inference/Pairs.h"

#include INR_TILES

namespace inr {
namespace INR_ISA {

static_assert(StripRows == 2 * TileSize && StripGroups % 2 == 0 && LaneCount == TileSize,
              "two by two tiles of sums");

/// Tiles are configured as long as this lives: for a batch. While they are, the system saves 8 KiB
/// more whenever it gives the processor to another thread, and other libraries in the process have
/// not been asked: nothing of ours leaves them configured behind, or while it calls what is not
/// ours.
class Batch
{
public:
  Batch() { ConfigureTiles(WholeTiles); }
  ~Batch() { ReleaseTiles(); }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
};

/// Activate, which may call the C library, without tiles.
inline void ActivateAll(Activation activation, float* values, std::int64_t count)
{
  if (activation == Activation::None) {
    return;
  }
  ReleaseTiles();
  Activate(activation, values, count);
  ConfigureTiles(WholeTiles);
}

/// What a tile of columns is made of: with INR_SPLIT numbers are sums of two bfloat16 numbers, a
/// rounded one and what that leaves. Of their products the one of both rests is left out, which is
/// no larger than what the rests' own rounding loses.
#ifdef INR_SPLIT
constexpr int Parts = 2;
#else
constexpr int Parts = 1;
#endif

/// Numbers of two columns as pairs, part by part.
struct PairParts
{
  __m512i parts[Parts];
};

inline PairParts PartsOf(Floats first, Floats second)
{
  PairParts pair;
  pair.parts[0] = PairOf(first, second);
  if constexpr (Parts == 2) {
    const auto bits = (UInts)pair.parts[0];
    pair.parts[1] = PairOf(first - (Floats)(bits << 16), second - (Floats)(bits & 0xffff0000u));
  }
  return pair;
}

/// Where a part of the k-th tile of inputs begins.
inline float* InputsOf(const Strip& strip, int tile, int part)
{
  return strip.values + (tile * Parts + part) * TileSize * StripSize;
}

/// Makes a tile of inputs of `count` rows, which may lie in it or behind.
template <int Groups> inline void PackTile(const float* rows, int count, float* tile)
{
  PairParts pairs[TileSize][Groups];
  for (int k = 0; k < TileSize; ++k) {
    for (int g = 0; g < Groups; ++g) {
      const float* const first = rows + 2 * k * StripSize + g * LaneCount;
      pairs[k][g] = PartsOf(2 * k < count ? Load(first) : Floats{},
                            2 * k + 1 < count ? Load(first + StripSize) : Floats{});
    }
  }
  for (int part = 0; part < Parts; ++part) {
    for (int k = 0; k < TileSize; ++k) {
      float* const to = tile + (part * TileSize + k) * StripSize;
      for (int g = 0; g < Groups; ++g) {
        std::memcpy(to + g * LaneCount, &pairs[k][g].parts[part], sizeof(__m512i));
      }
    }
  }
}

/// Makes encoded samples a layer's inputs: row f of `width` is in strip.values from f * StripSize
/// on.
template <int Groups> inline void BeginStrip(int width, Strip& strip)
{
  strip.count = (width + TileColumns - 1) / TileColumns; // of tiles
  for (int k = 0; k < strip.count; ++k) {
    const int first = k * TileColumns;
    PackTile<Groups>(strip.values + first * StripSize, width - first, InputsOf(strip, k, 0));
  }
}

// Sums are in tiles 0 to 3: tile 2 * t + g is of the t-th tile of rows and the g-th group of
// samples. Weights are in tiles 4 and 5, inputs in 6 and 7.

template <int RowTiles, int Groups> inline void ZeroSums()
{
  ZeroTile<0>();
  if constexpr (Groups == 2) {
    ZeroTile<1>();
  }
  if constexpr (RowTiles == 2) {
    ZeroTile<2>();
  }
  if constexpr (RowTiles == 2 && Groups == 2) {
    ZeroTile<3>();
  }
}

template <int RowTiles>
inline void LoadWeights(const std::uint32_t* weights, std::int64_t weightsOfRows)
{
  constexpr std::int64_t row = TileSize * sizeof(float);
  LoadTile<4>(weights, row);
  if constexpr (RowTiles == 2) {
    LoadTile<5>(weights + weightsOfRows, row);
  }
}

template <int Groups> inline void LoadInputs(const float* inputs)
{
  constexpr std::int64_t row = StripSize * sizeof(float);
  LoadTile<6>(inputs, row);
  if constexpr (Groups == 2) {
    LoadTile<7>(inputs + LaneCount, row);
  }
}

template <int RowTiles, int Groups> inline void AddProducts()
{
  MultiplyAddTiles<0, 4, 6>();
  if constexpr (Groups == 2) {
    MultiplyAddTiles<1, 4, 7>();
  }
  if constexpr (RowTiles == 2) {
    MultiplyAddTiles<2, 5, 6>();
  }
  if constexpr (RowTiles == 2 && Groups == 2) {
    MultiplyAddTiles<3, 5, 7>();
  }
}

/// Of the groups from the `first` on.
template <int RowTiles, int Groups>
inline void MultiplyTiles(const std::uint32_t* weights, std::int64_t weightsOfRows, const Strip& in,
                          int first)
{
  constexpr int tile = TileSize * TileSize;
  ZeroSums<RowTiles, Groups>();
  for (int k = 0; k < in.count; ++k) {
    const std::uint32_t* const column = weights + k * Parts * tile;
    LoadWeights<RowTiles>(column, weightsOfRows);
    if constexpr (Parts == 2) {
      LoadInputs<Groups>(InputsOf(in, k, 1) + first * LaneCount);
      AddProducts<RowTiles, Groups>();
    }
    LoadInputs<Groups>(InputsOf(in, k, 0) + first * LaneCount);
    AddProducts<RowTiles, Groups>();
    if constexpr (Parts == 2) {
      LoadWeights<RowTiles>(column + tile, weightsOfRows);
      AddProducts<RowTiles, Groups>();
    }
  }
}

/// Writes what MultiplyTiles has summed up: row r, group g to sums[r][first + g].
template <int RowTiles, int Groups, int All> inline void StoreSums(Floats (*sums)[All], int first)
{
  constexpr std::int64_t row = sizeof(*sums);
  StoreTile<0>(&sums[0][first], row);
  if constexpr (Groups == 2) {
    StoreTile<1>(&sums[0][first + 1], row);
  }
  if constexpr (RowTiles == 2) {
    StoreTile<2>(&sums[TileSize][first], row);
  }
  if constexpr (RowTiles == 2 && Groups == 2) {
    StoreTile<3>(&sums[TileSize][first + 1], row);
  }
}

/// Two groups at a time. While the sums of some are made, what becomes of the others' is on its way
/// through memory.
template <int RowTiles, int Groups>
inline void SumGroups(const std::uint32_t* weights, std::int64_t weightsOfRows, const Strip& in,
                      Floats (*sums)[Groups])
{
  for (int first = 0; first + 2 <= Groups; first += 2) {
    MultiplyTiles<RowTiles, 2>(weights, weightsOfRows, in, first);
    StoreSums<RowTiles, 2>(sums, first);
  }
  if constexpr (Groups % 2 == 1) {
    MultiplyTiles<RowTiles, 1>(weights, weightsOfRows, in, Groups - 1);
    StoreSums<RowTiles, 1>(sums, Groups - 1);
  }
}

inline std::int64_t WeightsOfTileRow(const LayerView& layer)
{
  const std::int64_t tiles = (layer.columns + TileColumns - 1) / TileColumns;
  return tiles * Parts * TileSize * TileSize;
}

/// Rows from `row` on, a multiple of StripRows; those beyond the last tile are zero.
template <int Rows, int Groups>
inline void SumTile(const LayerView& layer, int row, const Strip& in, Floats (&sums)[Rows][Groups])
{
  const std::int64_t step = WeightsOfTileRow(layer);
  const std::uint32_t* const weights = layer.pairs + row / TileSize * step;
  if (layer.rows - row > TileSize) {
    SumGroups<2>(weights, step, in, sums);
    return;
  }
  SumGroups<1>(weights, step, in, sums);
  std::memset(sums + TileSize, 0, TileSize * sizeof(sums[0]));
}

/// The first row.
template <int Groups>
inline void SumRow(const LayerView& layer, const Strip& in, Floats (&sums)[Groups])
{
  Floats all[TileSize][Groups];
  SumGroups<1>(layer.pairs, 0, in, all);
  std::memcpy(sums, all[0], sizeof(sums));
}

/// Appends rows to `out` in pairs after an activation: a tile of inputs of the next layer. What is
/// beyond the layer's last row has weights of zero there.
template <int Rows, int Groups>
inline void AppendTile(Activation activation, Floats (&sums)[Rows][Groups], int, int, Strip& out)
{
  const bool inRegisters = activation == Activation::ReLU || activation == Activation::None;
  if (!inRegisters) {
    float values[Rows * Groups * LaneCount];
    std::memcpy(values, sums, sizeof(values));
    ActivateAll(activation, values, Rows * Groups * LaneCount);
    std::memcpy(sums, values, sizeof(values));
  }
  const Floats lowest = Spread(activation == Activation::ReLU ? 0.0f : -__builtin_inff());
  for (int r = 0; r < Rows; r += 2) {
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      const PairParts pair = PartsOf(Maximum(lowest, sums[r][g]), Maximum(lowest, sums[r + 1][g]));
      for (int part = 0; part < Parts; ++part) {
        float* const to = InputsOf(out, out.count, part) + r / 2 * StripSize + g * LaneCount;
        std::memcpy(to, &pair.parts[part], sizeof(__m512i));
      }
    }
  }
  ++out.count;
}

} // namespace INR_ISA
} // namespace inr
