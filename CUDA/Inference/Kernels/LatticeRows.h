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

/// Cells of a level for an item's samples, along each axis.
struct LevelCells
{
  AxisCell axes[3][ItemSize];
};

/// The part of a level's lattice that an item's samples touch.
struct LatticePlan
{
  std::uint32_t lower[2]; ///< of its rows: y, z
  std::int32_t down;      ///< rows of a layer
  std::int32_t first;     ///< of its rows, y fastest; negative where they are not kept
  std::int32_t end;       ///< of the rows of this level and those before it
};

/// Rows of a level that are kept at most: beyond, samples lie in cells of their own.
constexpr int MostLatticeRows = (ItemSize + 1) * (ItemSize + 1);

/// Lattice points along y (axis 1) or z between the first and the last sample's cells.
INR_HOST_DEVICE inline std::int64_t PointsAlong(const LevelCells& cells, int axis)
{
  const AxisCell* const along = cells.axes[axis];
  return std::int64_t{along[ItemSize - 1].cell} - std::int64_t{along[0].cell} + 2;
}

/// Rows of such points; more than MostLatticeRows where they are too many to be counted.
INR_HOST_DEVICE inline std::int32_t RowsOf(const LevelCells& cells)
{
  const std::int64_t down = PointsAlong(cells, 1);
  const std::int64_t deep = PointsAlong(cells, 2);
  const bool few = down <= MostLatticeRows && deep <= MostLatticeRows;
  return few ? static_cast<std::int32_t>(down * deep) : MostLatticeRows + 1;
}

/// Of level l, after those of the levels before it that are kept; `capacity` rows fit.
INR_HOST_DEVICE inline LatticePlan PlanLattice(const LevelCells* cells, int l,
                                               std::int64_t capacity)
{
  std::int32_t end = 0;
  bool kept = false;
  std::int32_t rows = 0;
  for (int k = 0; k <= l; ++k) {
    rows = RowsOf(cells[k]);
    kept = rows <= MostLatticeRows && end + rows <= capacity;
    end += kept ? rows : 0;
  }
  LatticePlan plan{};
  for (int axis = 1; axis < 3; ++axis) {
    plan.lower[axis - 1] = cells[l].axes[axis][0].cell;
  }
  plan.down = kept ? static_cast<std::int32_t>(PointsAlong(cells[l], 1)) : 0;
  plan.first = kept ? end - rows : -1;
  plan.end = end;
  return plan;
}

/// Where a sample's features are, of row `row` of all.
INR_HOST_DEVICE inline int RowPlace(int row, int sample, int features)
{
  return (row * ItemSize + sample) * features;
}

/// A thread's share of all rows that are kept: an item's samples of each, features fastest.
template <int Features, class Number>
INR_HOST_DEVICE inline void FindRows(const GridView<Number>& grid, const LevelCells* cells,
                                     const LatticePlan* plans, float* rows, int thread, int threads)
{
  int l = 0;
  const int all = plans[grid.levelCount - 1].end * ItemSize;
  for (int k = thread; k < all; k += threads) {
    const int row = k / ItemSize;
    const int sample = k % ItemSize;
    while (row >= plans[l].end) {
      ++l;
    }
    const LevelView& level = grid.levels[l];
    const auto* const table = TableOf<Number, Features>(grid, level);
    const LatticePlan& plan = plans[l];
    const std::uint32_t y =
        plan.lower[0] + static_cast<std::uint32_t>((row - plan.first) % plan.down);
    const std::uint32_t z =
        plan.lower[1] + static_cast<std::uint32_t>((row - plan.first) / plan.down);
    const AxisCell& x = cells[l].axes[0][sample];
    const Entry<Number, Features> left = table[EntryOf(level, x.cell, y, z)];
    const Entry<Number, Features> right = table[EntryOf(level, x.cell + 1, y, z)];
    float features[Features];
    INR_UNROLL
    for (int f = 0; f < Features; ++f) {
      features[f] = Mix(left[f], right[f], x.weight);
    }
    Store(features, rows + RowPlace(row, sample, Features));
  }
}

} // namespace cuda
} // namespace inr
