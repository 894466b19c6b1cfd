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

static_assert(StripRows == 2 * TileSize && StripSize == 2 * LaneCount && LaneCount == TileSize,
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

/// Pairs up to a whole tile are zero from pair `count` on; the strip's count is that of tiles.
template <int Groups> inline void FillTile(int count, Strip& strip)
{
  strip.count = (count + TileSize - 1) / TileSize;
  for (int k = count; k < strip.count * TileSize; ++k) {
    for (int at = 0; at < Groups * LaneCount; at += LaneCount) {
      Store(strip.values + k * StripSize + at, Floats{});
    }
  }
}

/// Makes encoded samples a layer's inputs: row f of `width` is in strip.values from f * StripSize
/// on.
template <int Groups> inline void BeginStrip(int width, Strip& strip)
{
  FillTile<Groups>(PairRows<Groups>(width, strip), strip);
}

/// Sums in tiles 0 to 3: tile 2 * t + g is of the t-th tile of rows and the g-th group of samples.
/// Weights are in tiles 4 and 5, inputs in 6 and 7.
template <int RowTiles, int Groups>
inline void MultiplyTiles(const std::uint32_t* weights, std::int64_t weightsOfRows, const Strip& in)
{
  constexpr std::int64_t row = TileSize * sizeof(float);
  constexpr std::int64_t stripRow = StripSize * sizeof(float);
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
  for (int k = 0; k < in.count; ++k) {
    const float* const inputs = in.values + k * TileSize * StripSize;
    LoadTile<4>(weights + k * TileSize * TileSize, row);
    LoadTile<6>(inputs, stripRow);
    MultiplyAddTiles<0, 4, 6>();
    if constexpr (Groups == 2) {
      LoadTile<7>(inputs + LaneCount, stripRow);
      MultiplyAddTiles<1, 4, 7>();
    }
    if constexpr (RowTiles == 2) {
      LoadTile<5>(weights + weightsOfRows + k * TileSize * TileSize, row);
      MultiplyAddTiles<2, 5, 6>();
    }
    if constexpr (RowTiles == 2 && Groups == 2) {
      MultiplyAddTiles<3, 5, 7>();
    }
  }
}

/// Writes what MultiplyTiles has summed up: row r, group g to sums[r][g].
template <int RowTiles, int Groups> inline void StoreSums(Floats (*sums)[Groups])
{
  constexpr std::int64_t row = sizeof(*sums);
  StoreTile<0>(&sums[0][0], row);
  if constexpr (Groups == 2) {
    StoreTile<1>(&sums[0][1], row);
  }
  if constexpr (RowTiles == 2) {
    StoreTile<2>(&sums[TileSize][0], row);
  }
  if constexpr (RowTiles == 2 && Groups == 2) {
    StoreTile<3>(&sums[TileSize][1], row);
  }
}

inline std::int64_t WeightsOfTileRow(const LayerView& layer)
{
  return std::int64_t{(layer.columns + TileColumns - 1) / TileColumns} * TileSize * TileSize;
}

/// Rows from `row` on, a multiple of StripRows; those beyond the last tile are zero.
template <int Rows, int Groups>
inline void SumTile(const LayerView& layer, int row, const Strip& in, Floats (&sums)[Rows][Groups])
{
  const std::int64_t step = WeightsOfTileRow(layer);
  const std::uint32_t* const weights = layer.pairs + row / TileSize * step;
  if (layer.rows - row > TileSize) {
    MultiplyTiles<2, Groups>(weights, step, in);
    StoreSums<2, Groups>(sums);
    return;
  }
  MultiplyTiles<1, Groups>(weights, step, in);
  StoreSums<1, Groups>(sums);
  std::memset(sums + TileSize, 0, TileSize * sizeof(sums[0]));
}

/// The first row.
template <int Groups>
inline void SumRow(const LayerView& layer, const Strip& in, Floats (&sums)[Groups])
{
  MultiplyTiles<1, Groups>(layer.pairs, 0, in);
  Floats all[TileSize][Groups];
  StoreSums<1, Groups>(all);
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
  float* const to = out.values + out.count * TileSize * StripSize;
  for (int r = 0; r < Rows; r += 2) {
#pragma GCC unroll 2
    for (int g = 0; g < Groups; ++g) {
      const __m512i pair = PairOf(Maximum(lowest, sums[r][g]), Maximum(lowest, sums[r + 1][g]));
      std::memcpy(to + r / 2 * StripSize + g * LaneCount, &pair, sizeof(pair));
    }
  }
  ++out.count;
}

} // namespace INR_ISA
} // namespace inr
