// SPDX-License-Identifier: BSD-3-Clause
//
// The grid encoding for LaneCount samples at once; see Lanes.h for what may be in here.
#pragma once

#include "Core/Inference/Lanes.h"
#include "Core/Inference/ModelView.h"
#include "Core/Inference/Transpose.h"

#include <utility>

namespace inr {

namespace INR_ISA {

/// The eight corners of LaneCount samples on one level: table entries and interpolation weights.
struct Corners
{
  std::uint32_t entry[8][LaneCount];
  float weight[8][LaneCount];
};

struct Position
{
  Floats x, y, z;
};

/// Of LaneCount interleaved triples one coordinate, in registers: reading a vector soon after its
/// lanes were written stalls.
template <int Axis, int... Lane>
inline Floats TakeAxis(const Floats (&triples)[3], std::integer_sequence<int, Lane...>)
{
  const Floats lower = __builtin_shufflevector(
      triples[0], triples[1], (3 * Lane + Axis < 2 * LaneCount ? 3 * Lane + Axis : -1)...);
  return __builtin_shufflevector(
      lower, triples[2], (3 * Lane + Axis < 2 * LaneCount ? Lane : 3 * Lane + Axis - LaneCount)...);
}

/// LaneCount positions from interleaved triples, clamped to [0, 1]; `valid` of them exist, the rest
/// repeat the first. A NaN becomes 0.
inline Position LoadPositions(const float* xyz, std::int64_t valid)
{
  float copies[3 * LaneCount];
  if (valid < LaneCount) {
    for (int k = 0; k < LaneCount; ++k) {
      std::memcpy(copies + 3 * k, xyz + 3 * (k < valid ? k : 0), 3 * sizeof(float));
    }
    xyz = copies;
  }
  const Floats triples[3] = {Load(xyz), Load(xyz + LaneCount), Load(xyz + 2 * LaneCount)};
  constexpr std::make_integer_sequence<int, LaneCount> lanes;
  const Floats zero{};
  const Floats one = Spread(1.0f);
  return {Minimum(Maximum(TakeAxis<0>(triples, lanes), zero), one),
          Minimum(Maximum(TakeAxis<1>(triples, lanes), zero), one),
          Minimum(Maximum(TakeAxis<2>(triples, lanes), zero), one)};
}

/// Lattice cell and weight of one coordinate.
struct AxisCell
{
  UInts cell;
  Floats weight;
};

inline AxisCell LocateOnAxis(const LevelView& level, GridInterpolation interpolation, Floats u)
{
  const Floats one = Spread(1.0f);
  const Floats half = Spread(0.5f);
  const Floats scale = Spread(level.scale);
  const Floats position = u * scale;
  Ints cell = __builtin_convertvector(position + half, Ints); // u >= 0, so truncation is floor
  // On fine levels a float's last digit is a visible part of a cell: add what rounding lost, and
  // move on where that crosses into a neighbour.
  Floats weight = ((position - __builtin_convertvector(cell, Floats)) + half) +
                  ProductError(u, scale, position);
  const Ints below = weight < Floats{};
  const Ints above = weight >= one;
  cell += below - above; // a true comparison is -1
  weight = below ? weight + one : (above ? weight - one : weight);
  if (interpolation == GridInterpolation::Smoothstep) {
    weight = weight * weight * (Spread(3.0f) - 2.0f * weight);
  } else if (interpolation == GridInterpolation::Nearest) {
    weight = Floats{};
  }
  return {(UInts)cell, weight};
}

inline UInts WrapIndex(const LevelView& level, UInts index)
{
  if (level.wrap == IndexWrap::Mask) {
    return index & SpreadInt(level.entries - 1);
  }
  if (level.wrap == IndexWrap::Subtract) {
    const UInts entries = SpreadInt(level.entries);
    return index >= entries ? index - entries : index;
  }
  for (int k = 0; k < LaneCount; ++k) {
    index[k] %= level.entries;
  }
  return index;
}

// A corner's index before it is wrapped is made of a part for each axis: their sum in a lattice
// that is stored as a whole, else XOR of them (but for RandomHash).

inline bool IsRandom(const LevelView& level) { return level.hashed && level.randomHash; }

inline std::uint32_t FactorOf(const LevelView& level, int axis)
{
  return level.hashed ? level.primes[axis] : level.strides[axis];
}

template <class T> inline T JoinParts(const LevelView& level, T a, T b)
{
  return level.hashed ? a ^ b : a + b;
}

/// RandomHash. Not inlined: it calls what makes the compiler keep everything around in memory.
__attribute__((noinline)) inline void RandomEntries(const LevelView& level, const std::uint32_t* x,
                                                    const std::uint32_t* y, const std::uint32_t* z,
                                                    std::uint32_t* entries)
{
  for (int k = 0; k < LaneCount; ++k) {
    entries[k] = RandomHashOfCorner(x[k], y[k], z[k]) % level.entries;
  }
}

inline UInts RandomEntriesOf(const LevelView& level, UInts x, UInts y, UInts z)
{
  std::uint32_t at[3][LaneCount];
  std::memcpy(at[0], &x, sizeof(x));
  std::memcpy(at[1], &y, sizeof(y));
  std::memcpy(at[2], &z, sizeof(z));
  std::uint32_t entries[LaneCount];
  RandomEntries(level, at[0], at[1], at[2], entries);
  UInts all;
  std::memcpy(&all, entries, sizeof(all));
  return all;
}

/// Table entries of the eight corners from the lower one (cells[0], cells[1], cells[2]) on.
inline void FindEntries(const LevelView& level, const UInts (&cells)[3], Corners& corners)
{
  UInts parts[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    const UInts factor = SpreadInt(FactorOf(level, axis));
    parts[axis][0] = cells[axis] * factor;
    parts[axis][1] = parts[axis][0] + factor;
  }
  for (unsigned c = 0; c < 8; ++c) {
    const UInts inLayer = JoinParts(level, parts[0][c & 1u], parts[1][(c >> 1) & 1u]);
    const UInts entry = WrapIndex(level, JoinParts(level, inLayer, parts[2][c >> 2]));
    std::memcpy(corners.entry[c], &entry, sizeof(entry));
  }
}

inline void FindRandomEntries(const LevelView& level, const UInts (&cells)[3], Corners& corners)
{
  for (unsigned c = 0; c < 8; ++c) {
    const UInts entry = RandomEntriesOf(level, cells[0] + (c & 1u), cells[1] + ((c >> 1) & 1u),
                                        cells[2] + (c >> 2));
    std::memcpy(corners.entry[c], &entry, sizeof(entry));
  }
}

inline void FindCorners(const LevelView& level, GridInterpolation interpolation,
                        const Position& position, Corners& corners)
{
  const AxisCell x = LocateOnAxis(level, interpolation, position.x);
  const AxisCell y = LocateOnAxis(level, interpolation, position.y);
  const AxisCell z = LocateOnAxis(level, interpolation, position.z);
  const Floats one = Spread(1.0f);
  for (unsigned c = 0; c < 8; ++c) {
    const Floats weight = ((c & 1u) != 0 ? x.weight : one - x.weight) *
                          ((c & 2u) != 0 ? y.weight : one - y.weight) *
                          ((c & 4u) != 0 ? z.weight : one - z.weight);
    Store(corners.weight[c], weight);
  }
  const UInts cells[3] = {x.cell, y.cell, z.cell};
  IsRandom(level) ? FindRandomEntries(level, cells, corners) : FindEntries(level, cells, corners);
}

/// Interpolated features of one level: out[f * stride + lane].
template <int Features>
inline void InterpolateLevel(const float* table, const Corners& corners, float* out,
                             std::int64_t stride)
{
  constexpr int together = LaneCount < 8 ? LaneCount : 8;
  for (int first = 0; first < LaneCount; first += together) {
    Row<Features> rows[together];
    for (int k = 0; k < together; ++k) {
      Row<Features> sum{};
      for (int c = 0; c < 8; ++c) {
        Row<Features> row;
        std::memcpy(&row,
                    table + static_cast<std::uint64_t>(corners.entry[c][first + k]) * Features,
                    sizeof(row));
        sum += corners.weight[c][first + k] * row;
      }
      rows[k] = sum;
    }
    StoreColumns<Features>(rows, out + first, stride);
  }
}

/// All levels for LaneCount samples: encoded[(l*F + f) * stride + lane], zeros in the padding.
template <int Features>
inline void EncodeLanes(const ModelView& model, const Position& position, float* encoded,
                        std::int64_t stride)
{
  Corners corners;
  for (int l = 0; l < model.levelCount; ++l) {
    const LevelView& level = model.levels[l];
    FindCorners(level, model.interpolation, position, corners);
    InterpolateLevel<Features>(model.grid + level.offset, corners, encoded + l * Features * stride,
                               stride);
  }
  for (int row = model.encodedWidth; row < model.inputWidth; ++row) {
    Store(encoded + row * stride, Floats{});
  }
}

/// Encodes `count` positions in a block of `stride` samples (a multiple of LaneCount, >= count).
inline void EncodeBlock(const ModelView& model, const float* xyz, std::int64_t count,
                        float* encoded, std::int64_t stride)
{
  for (std::int64_t first = 0; first < count; first += LaneCount) {
    const Position position = LoadPositions(xyz + 3 * first, count - first);
    switch (model.features) {
    case 1:
      EncodeLanes<1>(model, position, encoded + first, stride);
      break;
    case 2:
      EncodeLanes<2>(model, position, encoded + first, stride);
      break;
    case 4:
      EncodeLanes<4>(model, position, encoded + first, stride);
      break;
    default:
      EncodeLanes<8>(model, position, encoded + first, stride);
      break;
    }
  }
}

} // namespace INR_ISA
} // namespace inr
