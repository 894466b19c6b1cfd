// SPDX-License-Identifier: BSD-3-Clause
//
// The grid encoding along a row of a regular lattice of samples; see Lanes.h for what may be in
// here. Neighbouring samples share corners: each corner is fetched and interpolated along z once
// for all samples around it, and along y once for all rows that lie between the same corners.
#pragma once

#include "Core/Inference/Encode.h"

namespace inr {

namespace INR_ISA {

/// Samples in a row that are encoded together.
constexpr int RowCapacity = 64;
/// Lattice points along x that they touch: two each, at most.
constexpr int ColumnCapacity = 2 * RowCapacity;

/// What a row keeps of one grid level.
struct LevelRow
{
  std::int32_t columnOf[RowCapacity]; ///< of each sample's lower corner, in `columns`
  float weight[RowCapacity];
  std::uint32_t columns[ColumnCapacity + LaneCount]; ///< x of the corners, rising
  int columnCount;
  std::uint32_t lineY[2]; ///< y of the corners in `lines`
  bool known[2];
  float lines[2][ColumnCapacity * 8]; ///< features of the corners, interpolated along z
};

inline void LocateRow(const LevelView& level, GridInterpolation interpolation, const float* x,
                      int count, LevelRow& row)
{
  std::uint32_t cells[RowCapacity + LaneCount];
  float weights[RowCapacity + LaneCount];
  for (int k = 0; k < count; k += LaneCount) {
    float lanes[LaneCount];
    for (int lane = 0; lane < LaneCount; ++lane) {
      lanes[lane] = x[k + lane < count ? k + lane : count - 1];
    }
    const AxisCell at = LocateOnAxis(level, interpolation, Load(lanes));
    std::memcpy(cells + k, &at.cell, sizeof(at.cell));
    Store(weights + k, at.weight);
  }
  row.columnCount = 0;
  for (int k = 0; k < count; ++k) {
    // Positions rise, so a cell is the last one, the one after it, or further on.
    int lower = row.columnCount - 2;
    if (row.columnCount > 0 && cells[k] == row.columns[row.columnCount - 1]) {
      lower = row.columnCount - 1;
    } else if (row.columnCount == 0 || cells[k] != row.columns[lower]) {
      lower = row.columnCount;
      row.columns[row.columnCount++] = cells[k];
    }
    if (lower == row.columnCount - 1) {
      row.columns[row.columnCount++] = cells[k] + 1;
    }
    row.columnOf[k] = lower;
    row.weight[k] = weights[k];
  }
  row.known[0] = row.known[1] = false;
}

/// Corners at height y, between the layers z and z + 1.
template <int Features>
inline void FetchLine(const LevelView& level, const float* table, std::uint32_t y, std::uint32_t z,
                      float weightZ, const LevelRow& row, float* line)
{
  for (int first = 0; first < row.columnCount; first += LaneCount) {
    UInts x;
    std::memcpy(&x, row.columns + first, sizeof(x));
    const UInts spreadY = SpreadInt(y);
    const UInts lower = WrapIndex(level, CornerIndex(level, x, spreadY, SpreadInt(z)));
    const UInts upper = WrapIndex(level, CornerIndex(level, x, spreadY, SpreadInt(z + 1)));
    for (int lane = 0; lane < LaneCount && first + lane < row.columnCount; ++lane) {
      Row<Features> below, above;
      std::memcpy(&below, table + static_cast<std::uint64_t>(lower[lane]) * Features,
                  sizeof(below));
      std::memcpy(&above, table + static_cast<std::uint64_t>(upper[lane]) * Features,
                  sizeof(above));
      const Row<Features> mixed = below + (above - below) * weightZ;
      std::memcpy(line + (first + lane) * Features, &mixed, sizeof(mixed));
    }
  }
}

/// The place in `row.lines` that holds height y; the other one holds what may not be lost.
template <int Features>
inline int LineAt(const LevelView& level, const float* table, std::uint32_t y, std::uint32_t z,
                  float weightZ, int other, LevelRow& row)
{
  for (int place = 0; place < 2; ++place) {
    if (row.known[place] && row.lineY[place] == y) {
      return place;
    }
  }
  const int place = other == 0 ? 1 : 0;
  FetchLine<Features>(level, table, y, z, weightZ, row, row.lines[place]);
  row.lineY[place] = y;
  row.known[place] = true;
  return place;
}

/// Features of `count` samples: out[f * stride + k].
template <int Features>
inline void EncodeRow(const LevelView& level, const float* table, const AxisCell& y,
                      const AxisCell& z, LevelRow& row, int count, float* out, std::int64_t stride)
{
  const float weightZ = z.weight[0];
  const std::uint32_t below = y.cell[0];
  const int upperKnown = row.known[0] && row.lineY[0] == below + 1 ? 0 : 1;
  const int lower = LineAt<Features>(level, table, below, z.cell[0], weightZ, upperKnown, row);
  const int upper = LineAt<Features>(level, table, below + 1, z.cell[0], weightZ, lower, row);
  const float weightY = y.weight[0];
  float line[ColumnCapacity * Features];
  for (int k = 0; k < row.columnCount * Features; ++k) {
    line[k] = row.lines[lower][k] + (row.lines[upper][k] - row.lines[lower][k]) * weightY;
  }
  for (int k = 0; k < count; ++k) {
    Row<Features> left, right;
    std::memcpy(&left, line + row.columnOf[k] * Features, sizeof(left));
    std::memcpy(&right, line + (row.columnOf[k] + 1) * Features, sizeof(right));
    const Row<Features> mixed = left + (right - left) * row.weight[k];
    for (int f = 0; f < Features; ++f) {
      out[f * stride + k] = mixed[f];
    }
  }
}

} // namespace INR_ISA
} // namespace inr
