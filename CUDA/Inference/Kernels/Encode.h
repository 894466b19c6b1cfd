// SPDX-License-Identifier: BSD-3-Clause
//
// The grid encoding of one sample by one thread. Cells and weights are, to the last bit, those of
// Core's kernels.
#pragma once

#include "CUDA/Device/Kernels/Mix.h"
#include "CUDA/Device/Kernels/Tiles.h"
#include "Core/Inference/ModelView.h"
#include "Core/Model/GridIndex.h"

#include <cmath>

namespace inr {
namespace cuda {

/// A model's grid, in the memory of whoever runs the kernel. `Number`: float or HalfBits.
template <class Number> struct GridView
{
  const LevelView* levels;
  int levelCount;
  int features;
  GridInterpolation interpolation;
  const Number* table; ///< features of all levels; aligned to 16 bytes
};

struct Point
{
  float x, y, z;
};

/// To [0, 1]; a NaN becomes 0.
INR_HOST_DEVICE inline float ClampToUnit(float u)
{
  return u > 0.0f ? (u < 1.0f ? u : 1.0f) : 0.0f;
}

/// Lattice cell and weight of one coordinate.
struct alignas(8) AxisCell
{
  std::uint32_t cell;
  float weight;
};

/// `u` in [0, 1]. See Core/Inference/Encode.h for what is added and why.
INR_HOST_DEVICE inline AxisCell LocateOnAxis(float scale, GridInterpolation interpolation, float u)
{
  const float position = u * scale;
  auto cell = static_cast<std::int32_t>(position + 0.5f);
  float weight = ((position - static_cast<float>(cell)) + 0.5f) + fmaf(u, scale, -position);
  if (weight < 0.0f) {
    --cell;
    weight += 1.0f;
  } else if (weight >= 1.0f) {
    ++cell;
    weight -= 1.0f;
  }
  if (interpolation == GridInterpolation::Smoothstep) {
    weight = weight * weight * (3.0f - 2.0f * weight);
  } else if (interpolation == GridInterpolation::Nearest) {
    weight = 0.0f;
  }
  return {static_cast<std::uint32_t>(cell), weight};
}

/// Table entry of a lattice corner.
INR_HOST_DEVICE inline std::uint32_t EntryOf(const LevelView& level, std::uint32_t x,
                                             std::uint32_t y, std::uint32_t z)
{
  std::uint32_t index = 0;
  if (!level.hashed) {
    index = x * level.strides[0] + y * level.strides[1] + z * level.strides[2];
  } else if (level.randomHash) {
    index = HashCorner(HashFunction::Rng, x, y, z);
  } else {
    index = HashCorner({level.primes[0], level.primes[1], level.primes[2]}, x, y, z);
  }
  switch (level.wrap) {
  case IndexWrap::Mask:
    return index & (level.entries - 1);
  case IndexWrap::Subtract:
    return index >= level.entries ? index - level.entries : index;
  default:
    return index % level.entries;
  }
}

/// An entry's features, read at once.
template <class Number, int Features> struct Entry;

template <int Features> struct alignas(Features < 4 ? 4 * Features : 16) Entry<float, Features>
{
  float features[Features];

  INR_HOST_DEVICE float operator[](int f) const { return this->features[f]; }
};

template <int Features> struct alignas(2 * Features) Entry<HalfBits, Features>
{
  PairBits pairs[Features / 2];

  INR_HOST_DEVICE float operator[](int f) const
  {
    return f % 2 == 0 ? LowHalf(this->pairs[f / 2]) : HighHalf(this->pairs[f / 2]);
  }
};

template <> struct Entry<HalfBits, 1>
{
  HalfBits feature;

  INR_HOST_DEVICE float operator[](int) const { return ToFloat(this->feature); }
};

/// The place of a sample in a cell.
struct CellWeights
{
  float x, y, z;

  INR_HOST_DEVICE float ofCorner(int corner) const
  {
    return ((corner & 1) != 0 ? this->x : 1.0f - this->x) *
           ((corner & 2) != 0 ? this->y : 1.0f - this->y) *
           ((corner & 4) != 0 ? this->z : 1.0f - this->z);
  }
};

/// Interpolated features; entryOf(c) is corner c's entry, bit 0 of c for x. Along x, then z, then
/// y: kernels of bricks share what they find along the first ones, and come to the same bits.
template <int Features, class Number, class EntryOfCorner>
INR_HOST_DEVICE inline void Interpolate(const CellWeights& weights, const EntryOfCorner& entryOf,
                                        float (&features)[Features])
{
  Entry<Number, Features> entries[8]; // all of them on their way before the first is used
  INR_UNROLL
  for (int corner = 0; corner < 8; ++corner) {
    entries[corner] = entryOf(corner);
  }
  float rows[2][Features]; // of y
  INR_UNROLL
  for (int y = 0; y < 2; ++y) {
    INR_UNROLL
    for (int f = 0; f < Features; ++f) {
      const float front = Mix(entries[2 * y][f], entries[2 * y + 1][f], weights.x);
      const float back = Mix(entries[2 * y + 4][f], entries[2 * y + 5][f], weights.x);
      rows[y][f] = Mix(front, back, weights.z);
    }
  }
  INR_UNROLL
  for (int f = 0; f < Features; ++f) {
    features[f] = Mix(rows[0][f], rows[1][f], weights.y);
  }
}

template <class Number, int Features>
INR_HOST_DEVICE inline const Entry<Number, Features>* TableOf(const GridView<Number>& grid,
                                                              const LevelView& level)
{
  return reinterpret_cast<const Entry<Number, Features>*>(grid.table + level.offset);
}

/// Features of one level at a sample whose cell is known.
template <int Features, class Number>
INR_HOST_DEVICE inline void InterpolateCell(const GridView<Number>& grid, const LevelView& level,
                                            const AxisCell& x, const AxisCell& y, const AxisCell& z,
                                            float (&sums)[Features])
{
  const auto* const table = TableOf<Number, Features>(grid, level);
  const auto at = [&](int corner) {
    const auto bits = static_cast<std::uint32_t>(corner);
    return table[EntryOf(level, x.cell + (bits & 1u), y.cell + (bits >> 1 & 1u),
                         z.cell + (bits >> 2))];
  };
  Interpolate<Features, Number>({x.weight, y.weight, z.weight}, at, sums);
}

/// Features of one level at a point.
template <int Features, class Number>
INR_HOST_DEVICE inline void InterpolateAt(const GridView<Number>& grid, const LevelView& level,
                                          const Point& point, float (&sums)[Features])
{
  InterpolateCell(grid, level, LocateOnAxis(level.scale, grid.interpolation, point.x),
                  LocateOnAxis(level.scale, grid.interpolation, point.y),
                  LocateOnAxis(level.scale, grid.interpolation, point.z), sums);
}

/// Writes features to `to`, aligned to as many bytes as they are, up to 16.
template <int Features>
INR_HOST_DEVICE inline void Store(const float (&values)[Features], float* to)
{
  Entry<float, Features> entry;
  INR_UNROLL
  for (int f = 0; f < Features; ++f) {
    entry.features[f] = values[f];
  }
  *reinterpret_cast<Entry<float, Features>*>(to) = entry;
}
template <int Features>
INR_HOST_DEVICE inline void Store(const float (&values)[Features], HalfBits* to)
{
  if constexpr (Features == 1) {
    *to = static_cast<HalfBits>(PackHalves(values[0], 0.0f));
  } else {
    Entry<HalfBits, Features> entry;
    INR_UNROLL
    for (int f = 0; f < Features; f += 2) {
      entry.pairs[f / 2] = PackHalves(values[f], values[f + 1]);
    }
    *reinterpret_cast<Entry<HalfBits, Features>*>(to) = entry;
  }
}

/// Calls `function(FeatureCount<F>())` for the F that is `features`: 1, 2, 4 or 8.
template <int Count> struct FeatureCount
{
  static constexpr int value = Count;
};
template <class Function>
INR_HOST_DEVICE inline void WithFeatures(int features, const Function& function)
{
  switch (features) {
  case 1:
    return function(FeatureCount<1>());
  case 2:
    return function(FeatureCount<2>());
  case 4:
    return function(FeatureCount<4>());
  default:
    return function(FeatureCount<8>());
  }
}

/// A row for the network: features of all levels, and zeros up to a whole tile. `encodeLevel(l,
/// features)` gives those of level l.
template <int Features, class Staged, class EncodeLevel>
INR_HOST_DEVICE inline void EncodeRow(int levelCount, const EncodeLevel& encodeLevel, Staged* row)
{
  for (int l = 0; l < levelCount; ++l) {
    float features[Features];
    encodeLevel(l, features);
    Store(features, row + l * Features);
  }
  for (int column = levelCount * Features; column % TileSize != 0; ++column) {
    row[column] = 0;
  }
}

} // namespace cuda
} // namespace inr
