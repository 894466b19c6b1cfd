// SPDX-License-Identifier: BSD-3-Clause
//
// What neighbouring samples share of the grid: a cube of samples lies in few cells of a coarse
// level. Their corners are fetched once, into shared memory.
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
  std::uint32_t lower[3];
  std::int32_t size[3];
  std::int32_t first; ///< of its points, in `lattice`; negative where they are not kept there
};

/// Lattice points of a level that are kept at most: beyond, samples share little, as an item's
/// have 4096 corners.
constexpr std::int64_t MostLatticePoints = 2048;

/// Points of the lattice between the first and the last sample's cells; more than MostLatticePoints
/// where they are too many to be counted.
INR_HOST_DEVICE inline std::int64_t LatticePoints(const LevelCells& cells)
{
  std::int64_t points = 1;
  for (const auto& axis : cells.axes) {
    const std::int64_t along =
        std::int64_t{axis[ItemSize - 1].cell} - std::int64_t{axis[0].cell} + 2;
    points *= along <= MostLatticePoints ? along : MostLatticePoints + 1;
  }
  return points;
}

/// Of level l, after those of the levels before it that are kept; `capacity` points fit.
INR_HOST_DEVICE inline LatticePlan PlanLattice(const LevelCells* cells, int l,
                                               std::int64_t capacity)
{
  LatticePlan plan{};
  for (int axis = 0; axis < 3; ++axis) {
    const AxisCell* const along = cells[l].axes[axis];
    plan.lower[axis] = along[0].cell;
    plan.size[axis] = static_cast<std::int32_t>(along[ItemSize - 1].cell - along[0].cell) + 2;
  }
  std::int64_t before = 0;
  for (int k = 0; k < l; ++k) {
    const std::int64_t points = LatticePoints(cells[k]);
    before += points <= MostLatticePoints ? points : 0;
  }
  const std::int64_t points = LatticePoints(cells[l]);
  const bool kept = points <= MostLatticePoints && before + points <= capacity;
  plan.first = kept ? static_cast<std::int32_t>(before) : -1;
  return plan;
}

/// Fetches a level's points, one thread's share of them.
template <int Features>
INR_HOST_DEVICE inline void
FetchLattice(const GridView<HalfBits>& grid, int l, const LatticePlan& plan,
             Entry<HalfBits, Features>* lattice, int thread, int threads)
{
  if (plan.first < 0) {
    return;
  }
  const LevelView& level = grid.levels[l];
  const auto* const table = TableOf<HalfBits, Features>(grid, level);
  const int points = plan.size[0] * plan.size[1] * plan.size[2];
  for (int k = thread; k < points; k += threads) {
    const int x = k % plan.size[0];
    const int y = k / plan.size[0] % plan.size[1];
    const int z = k / (plan.size[0] * plan.size[1]);
    lattice[plan.first + k] = table[EntryOf(level, plan.lower[0] + static_cast<std::uint32_t>(x),
                                            plan.lower[1] + static_cast<std::uint32_t>(y),
                                            plan.lower[2] + static_cast<std::uint32_t>(z))];
  }
}

/// Features of a level at sample (x, y, z) of an item.
template <int Features>
INR_HOST_DEVICE inline void InterpolateShared(const GridView<HalfBits>& grid, int l,
                                              const LevelCells& cells, const LatticePlan& plan,
                                              const Entry<HalfBits, Features>* lattice,
                                              const int (&sample)[3], float (&sums)[Features])
{
  const AxisCell& x = cells.axes[0][sample[0]];
  const AxisCell& y = cells.axes[1][sample[1]];
  const AxisCell& z = cells.axes[2][sample[2]];
  if (plan.first < 0) {
    InterpolateCell(grid, grid.levels[l], x, y, z, sums);
    return;
  }
  const int rows = static_cast<int>(z.cell - plan.lower[2]) * plan.size[1] +
                   static_cast<int>(y.cell - plan.lower[1]);
  const int first = plan.first + rows * plan.size[0] + static_cast<int>(x.cell - plan.lower[0]);
  const int layer = plan.size[0] * plan.size[1];
  const auto at = [&](int corner) {
    return lattice[first + (corner & 1) + (corner >> 1 & 1) * plan.size[0] + (corner >> 2) * layer];
  };
  Interpolate<Features, HalfBits>({x.weight, y.weight, z.weight}, at, sums);
}

} // namespace cuda
} // namespace inr
