// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbouring samples share of the grid: a cube of samples lies in few cells of a coarse
// level. Each row of lattice points along x is interpolated once, at the samples' x, into shared
// memory.
#pragma once

#include "CUDA/Inference/Kernels/BrickGeometry.h"
#include "CUDA/Inference/Kernels/Encode.h"

namespace inr {
namespace cuda {

/// Where an item's samples are in a level of the grid.
struct LevelPart
{
  AxisCell axes[3][ItemSize]; ///< cells of y and z are counted from the first sample's on
  std::uint32_t lower[2];     ///< those of the first sample
  std::int32_t down;          ///< lattice points between the first and the last sample, along y
  std::int32_t rows;          ///< of such points, along x; more than MostLatticeRows: very many
  std::int32_t first;         ///< of its rows among those that are kept; negative where its are not
};

/// Rows of a level that are kept at most: beyond, samples lie in cells of their own.
constexpr int MostLatticeRows = (ItemSize + 1) * (ItemSize + 1);

/// Rows that are kept of a level with so many, where there is room for `left` more.
INR_HOST_DEVICE inline std::int32_t KeptRows(std::int32_t rows, std::int32_t left)
{
  return rows <= MostLatticeRows && rows <= left ? rows : 0;
}

/// A sample's coordinates along an axis, and the level's cells there.
class SamplePlaces
{
public:
  /// `coordinates`: ItemSize of each axis.
  INR_HOST_DEVICE SamplePlaces(const float* coordinates, const LevelView& level,
                               GridInterpolation interpolation)
      : Coordinates(coordinates), Scale(level.scale), Interpolation(interpolation)
  {}

  INR_HOST_DEVICE AxisCell cell(int axis, int sample) const
  {
    return LocateOnAxis(this->Scale, this->Interpolation,
                        this->Coordinates[axis * ItemSize + sample]);
  }
  /// Lattice points between the first and the last sample.
  INR_HOST_DEVICE std::int64_t pointsAlong(int axis) const
  {
    return std::int64_t{this->cell(axis, ItemSize - 1).cell} -
           std::int64_t{this->cell(axis, 0).cell} + 2;
  }

private:
  const float* Coordinates;
  float Scale;
  GridInterpolation Interpolation;
};

/// Cell number k of the 3 * ItemSize of a level.
INR_HOST_DEVICE inline void SetCell(const SamplePlaces& places, int k, LevelPart& part)
{
  const int axis = k / ItemSize;
  AxisCell cell = places.cell(axis, k % ItemSize);
  if (axis > 0) {
    cell.cell -= places.cell(axis, 0).cell;
  }
  part.axes[axis][k % ItemSize] = cell;
}

/// All but the cells, and `first`.
INR_HOST_DEVICE inline void SetExtent(const SamplePlaces& places, LevelPart& part)
{
  const std::int64_t down = places.pointsAlong(1);
  const std::int64_t deep = places.pointsAlong(2);
  const bool few = down <= MostLatticeRows && deep <= MostLatticeRows;
  part.lower[0] = places.cell(1, 0).cell;
  part.lower[1] = places.cell(2, 0).cell;
  part.down = few ? static_cast<std::int32_t>(down) : 0;
  part.rows = few ? static_cast<std::int32_t>(down * deep) : MostLatticeRows + 1;
}

/// Sets `first` of level l, behind those before it that are kept; `capacity` rows fit.
INR_HOST_DEVICE inline void SetFirst(LevelPart* parts, int l, std::int32_t capacity)
{
  std::int32_t first = 0;
  for (int k = 0; k < l; ++k) {
    first += KeptRows(parts[k].rows, capacity - first);
  }
  parts[l].first = KeptRows(parts[l].rows, capacity - first) > 0 ? first : -1;
}

/// Where a sample's features are, of row `row` of all.
INR_HOST_DEVICE inline int RowPlace(int row, int sample, int features)
{
  return (row * ItemSize + sample) * features;
}

/// A row at one sample's x.
template <int Features, class Number>
INR_HOST_DEVICE inline void FindRow(const GridView<Number>& grid, const LevelView& level,
                                    const LevelPart& part, int row, int sample, float* to)
{
  const auto* const table = TableOf<Number, Features>(grid, level);
  const std::uint32_t y = part.lower[0] + static_cast<std::uint32_t>(row % part.down);
  const std::uint32_t z = part.lower[1] + static_cast<std::uint32_t>(row / part.down);
  const AxisCell& x = part.axes[0][sample];
  const Entry<Number, Features> left = table[EntryOf(level, x.cell, y, z)];
  const Entry<Number, Features> right = table[EntryOf(level, x.cell + 1, y, z)];
  float features[Features];
  INR_UNROLL
  for (int f = 0; f < Features; ++f) {
    features[f] = Mix(left[f], right[f], x.weight);
  }
  Store(features, to);
}

/// A thread's share of all rows that are kept: an item's samples of each, features fastest.
template <int Features, class Number>
INR_HOST_DEVICE inline void FindRows(const GridView<Number>& grid, const LevelPart* parts,
                                     std::int32_t capacity, float* rows, int thread, int threads)
{
  int next = 0; // level
  std::int32_t first = 0;
  std::int32_t end = 0;
  for (int k = thread;; k += threads) {
    const int row = k / ItemSize;
    while (row >= end) {
      if (next == grid.levelCount) {
        return;
      }
      first = end;
      end += KeptRows(parts[next].rows, capacity - end);
      ++next;
    }
    FindRow<Features>(grid, grid.levels[next - 1], parts[next - 1], row - first, k % ItemSize,
                      rows + RowPlace(row, k % ItemSize, Features));
  }
}

} // namespace cuda
} // namespace inr
