// SPDX-License-Identifier: BSD-3-Clause
//
// Matrix times a block of samples; see Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Lanes.h"

namespace inr {
namespace INR_ISA {

/// Registers hold a tile of TileRows outputs by TileGroups * LaneCount samples.
constexpr int TileRows = 4;
constexpr int TileGroups = LaneCount == 16 ? 4 : 2; // at most 4; see MultiplyBlock

/// A matrix in memory: element (r, c) is at data[r * rowStep + c * columnStep], so that a transpose
/// is a view too.
struct MatrixView
{
  const float* data;
  int rows;
  int columns;
  std::int64_t rowStep;
  std::int64_t columnStep;
};

template <int Rows, int Groups>
inline void MultiplyTile(const MatrixView& matrix, int row, const float* in, std::int64_t stride,
                         float* out)
{
  Floats sums[Rows][Groups] = {};
  const float* weights = matrix.data + row * matrix.rowStep;
  for (int c = 0; c < matrix.columns; ++c) {
    Floats input[Groups];
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      input[g] = Load(in + c * stride + g * LaneCount);
    }
#pragma GCC unroll 4
    for (int r = 0; r < Rows; ++r) {
      const Floats weight = Spread(weights[r * matrix.rowStep + c * matrix.columnStep]);
#pragma GCC unroll 4
      for (int g = 0; g < Groups; ++g) {
        sums[r][g] = MultiplyAdd(weight, input[g], sums[r][g]);
      }
    }
  }
#pragma GCC unroll 4
  for (int r = 0; r < Rows; ++r) {
#pragma GCC unroll 4
    for (int g = 0; g < Groups; ++g) {
      Store(out + (row + r) * stride + g * LaneCount, sums[r][g]);
    }
  }
}

template <int Groups>
inline void MultiplyStrip(const MatrixView& matrix, const float* in, std::int64_t stride,
                          float* out)
{
  int row = 0;
  for (; row + TileRows <= matrix.rows; row += TileRows) {
    MultiplyTile<TileRows, Groups>(matrix, row, in, stride, out);
  }
  for (; row < matrix.rows; ++row) {
    MultiplyTile<1, Groups>(matrix, row, in, stride, out);
  }
}

/// out = matrix * in for `samples` columns (a multiple of LaneCount); row r of `in` and `out`
/// starts at r * stride. A sample's sum runs over the columns in order, whatever the tile it falls
/// into.
inline void MultiplyBlock(const MatrixView& matrix, const float* in, std::int64_t stride,
                          std::int64_t samples, float* out)
{
  std::int64_t first = 0;
  for (; first + TileGroups * LaneCount <= samples; first += TileGroups * LaneCount) {
    MultiplyStrip<TileGroups>(matrix, in + first, stride, out + first);
  }
  if (samples - first == 3 * LaneCount) {
    MultiplyStrip<3>(matrix, in + first, stride, out + first);
  } else if (samples - first == 2 * LaneCount) {
    MultiplyStrip<2>(matrix, in + first, stride, out + first);
  } else if (samples > first) {
    MultiplyStrip<1>(matrix, in + first, stride, out + first);
  }
}

} // namespace INR_ISA
} // namespace inr
