// SPDX-License-Identifier: BSD-3-Clause
//
// The grid encoding on a regular lattice of samples; see Lanes.h for what may be in here.
// Neighbouring samples share corners. A piece is eight samples along x in one layer of the lattice:
// what it needs of the grid at one height y is fetched, interpolated along z and x and kept while
// the piece moves on along y, so that a row between known heights costs one interpolation.
#pragma once

#include "Core/Inference/Encode.h"
#include "Core/Inference/Transpose.h"

namespace inr {

namespace INR_ISA {

/// Samples in a piece, along x.
constexpr int PieceWidth = 8;
/// Lattice points along x that they touch: two each, at most.
constexpr int ColumnCapacity = 2 * PieceWidth;
/// Rows (of a piece) that are encoded together.
constexpr int RowCapacity = 16;

/// What a piece keeps of one grid level.
struct LevelPiece
{
  std::int32_t lower[PieceWidth]; ///< each sample's lower corner, in `columns`
  float weight[PieceWidth];
  std::uint32_t columns[ColumnCapacity + LaneCount]; ///< x of the corners, rising
  std::uint32_t parts[ColumnCapacity + LaneCount];   ///< of their indices
  int columnCount;
  std::uint32_t z; ///< lower corner of the layer
  float weightZ;
  bool known[2];
  std::uint32_t lineY[2]; ///< y of the corners in `lines`
  Octet lines[2][8];      ///< features at the samples' x and z and the corners' y
};

/// Coordinates of as many samples along an axis as are located together; the missing ones repeat
/// the last one.
struct Coordinates
{
  float u[RowCapacity];
};

inline void LoadCoordinates(const float* from, int count, Coordinates& to)
{
  std::memcpy(to.u, from, static_cast<std::size_t>(count) * sizeof(float));
  for (int k = count; k < RowCapacity; ++k) {
    to.u[k] = from[count - 1];
  }
}

/// Cells and weights of the first `count`, rounded up to LaneCount.
inline void LocateSome(const LevelView& level, GridInterpolation interpolation,
                       const Coordinates& coordinates, int count, std::uint32_t* cells,
                       float* weights)
{
  for (int k = 0; k < count; k += LaneCount) {
    const AxisCell at = LocateOnAxis(level, interpolation, Load(coordinates.u + k));
    std::memcpy(cells + k, &at.cell, sizeof(at.cell));
    Store(weights + k, at.weight);
  }
}

/// Begins a piece.
inline void LocatePiece(const LevelView& level, GridInterpolation interpolation,
                        const Coordinates& x, LevelPiece& piece)
{
  std::uint32_t cells[RowCapacity];
  float weights[RowCapacity];
  LocateSome(level, interpolation, x, PieceWidth, cells, weights);
  piece.columnCount = 0;
  for (int k = 0; k < PieceWidth; ++k) {
    // Positions rise, so a cell is the last one, the one after it, or further on.
    int lower = piece.columnCount - 2;
    if (piece.columnCount > 0 && cells[k] == piece.columns[piece.columnCount - 1]) {
      lower = piece.columnCount - 1;
    } else if (piece.columnCount == 0 || cells[k] != piece.columns[lower]) {
      lower = piece.columnCount;
      piece.columns[piece.columnCount++] = cells[k];
    }
    if (lower == piece.columnCount - 1) {
      piece.columns[piece.columnCount++] = cells[k] + 1;
    }
    piece.lower[k] = lower;
    piece.weight[k] = weights[k];
  }
  for (int k = 0; k < piece.columnCount; ++k) {
    piece.parts[k] = piece.columns[k] * FactorOf(level, 0);
  }
}

/// Table entries of LaneCount of the piece's columns, from the `first` on, at y and z.
inline UInts EntriesOfColumns(const LevelView& level, const LevelPiece& piece, int first,
                              std::uint32_t y, std::uint32_t z)
{
  UInts x;
  if (IsRandom(level)) {
    std::memcpy(&x, piece.columns + first, sizeof(x));
    return RandomEntriesOf(level, x, SpreadInt(y), SpreadInt(z));
  }
  std::memcpy(&x, piece.parts + first, sizeof(x));
  const std::uint32_t rest = JoinParts(level, y * FactorOf(level, 1), z * FactorOf(level, 2));
  return WrapIndex(level, JoinParts(level, x, SpreadInt(rest)));
}

/// Moves a piece to the layer at z, the first coordinate.
inline void BeginLayer(const LevelView& level, GridInterpolation interpolation,
                       const Coordinates& z, LevelPiece& piece)
{
  std::uint32_t cells[RowCapacity];
  float weights[RowCapacity];
  LocateSome(level, interpolation, z, 1, cells, weights);
  piece.z = cells[0];
  piece.weightZ = weights[0];
  piece.known[0] = piece.known[1] = false;
}

/// Features of the piece's corners at height y, interpolated along z: one corner after the other.
template <int Features>
inline void FetchCorners(const LevelView& level, const float* table, std::uint32_t y,
                         const LevelPiece& piece, Row<Features>* corners)
{
  for (int first = 0; first < piece.columnCount; first += LaneCount) {
    const UInts lower = EntriesOfColumns(level, piece, first, y, piece.z);
    const UInts upper = EntriesOfColumns(level, piece, first, y, piece.z + 1);
    std::uint32_t entries[2][LaneCount];
    std::memcpy(entries[0], &lower, sizeof(lower));
    std::memcpy(entries[1], &upper, sizeof(upper));
    for (int lane = 0; lane < LaneCount && first + lane < piece.columnCount; ++lane) {
      Row<Features> below, above;
      std::memcpy(&below, table + static_cast<std::uint64_t>(entries[0][lane]) * Features,
                  sizeof(below));
      std::memcpy(&above, table + static_cast<std::uint64_t>(entries[1][lane]) * Features,
                  sizeof(above));
      corners[first + lane] = below + (above - below) * piece.weightZ;
    }
  }
}

/// Features of the piece's samples at a corner's height y.
template <int Features>
inline void FetchLine(const LevelView& level, const float* table, std::uint32_t y,
                      const LevelPiece& piece, Octet* line)
{
  Row<Features> corners[ColumnCapacity];
  FetchCorners<Features>(level, table, y, piece, corners);
  Row<Features> samples[PieceWidth];
#pragma GCC unroll 8
  for (int k = 0; k < PieceWidth; ++k) {
    const Row<Features> left = corners[piece.lower[k]];
    samples[k] = left + (corners[piece.lower[k] + 1] - left) * piece.weight[k];
  }
  TransposeSamples(samples, line);
}

/// The place in `piece.lines` that holds height y; the other one holds what may not be lost.
template <int Features>
inline int LineAt(const LevelView& level, const float* table, std::uint32_t y, int other,
                  LevelPiece& piece)
{
  for (int place = 0; place < 2; ++place) {
    if (piece.known[place] && piece.lineY[place] == y) {
      return place;
    }
  }
  const int place = other == 0 ? 1 : 0;
  FetchLine<Features>(level, table, y, piece, piece.lines[place]);
  piece.lineY[place] = y;
  piece.known[place] = true;
  return place;
}

/// Features of a piece in `rows` rows at heights y: out[f * stride + row * PieceWidth + sample].
template <int Features>
inline void EncodeRows(const LevelView& level, GridInterpolation interpolation, const float* table,
                       const Coordinates& y, int rows, LevelPiece& piece, float* out,
                       std::int64_t stride)
{
  std::uint32_t cells[RowCapacity];
  float weights[RowCapacity];
  LocateSome(level, interpolation, y, rows, cells, weights);
  for (int row = 0; row < rows; ++row) {
    const std::uint32_t below = cells[row];
    const int upperKnown = piece.known[0] && piece.lineY[0] == below + 1 ? 0 : 1;
    const int lower = LineAt<Features>(level, table, below, upperKnown, piece);
    const int upper = LineAt<Features>(level, table, below + 1, lower, piece);
    for (int f = 0; f < Features; ++f) {
      const Octet from = piece.lines[lower][f];
      const Octet mixed = from + (piece.lines[upper][f] - from) * weights[row];
      std::memcpy(out + f * stride + row * PieceWidth, &mixed, sizeof(mixed));
    }
  }
}

} // namespace INR_ISA
} // namespace inr
