// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/VisibleBlocks.h"

#include <algorithm>

namespace inr {

namespace {

/// Voxels: more than the places of samples and the faces of cells are rounded by.
constexpr double Margin = 0.01;

bool AnyVisible(const MajorantGridView& grid, const glm::i64vec3& first, const glm::i64vec3& last)
{
  for (std::int64_t z = first.z; z <= last.z; ++z) {
    for (std::int64_t y = first.y; y <= last.y; ++y) {
      for (std::int64_t x = first.x; x <= last.x; ++x) {
        if (grid.extinction(grid.index({x, y, z})) > 0.0f) {
          return true;
        }
      }
    }
  }
  return false;
}

} // namespace

VisibleBlocks::CellSpan VisibleBlocks::cellsAround(const BrickId& brick, int axis, int block,
                                                   const MajorantGridView& grid) const
{
  const auto size = static_cast<double>(this->Levels.size(brick.level)[axis]);
  const auto origin = static_cast<double>(this->Levels.firstVoxel(brick)[axis]);
  const BlockLattice::Span voxels = this->Lattice.voxelsOf({block, block}, axis);
  const double first = origin + voxels.first;
  const double last = origin + voxels.last;
  if (first > size - 1.0) { // beyond the volume
    return {0, -1};
  }
  const double reach = this->Reach + Margin;
  const double perVoxel = 1.0 / (size * grid.spacing()[axis]);
  const std::int64_t end = grid.dims()[axis] - 1;
  // What is outside of the outermost voxels is read from those.
  const double low = first <= 0.0 ? 0.0 : (first + 0.5 - reach) * perVoxel;
  const double high = (last + 0.5 + reach) * perVoxel;
  const std::int64_t from = std::clamp(static_cast<std::int64_t>(low), std::int64_t{0}, end);
  return {from, last >= size - 1.0 ? end : std::clamp(static_cast<std::int64_t>(high), from, end)};
}

BlockSet VisibleBlocks::of(BrickKey key) const
{
  const BrickId brick = IdOf(key);
  const MajorantGridView& grid = this->Cells.grid(this->Cells.gridFor(brick.level));
  CellSpan cells[3][BlockLattice::Most];
  for (int axis = 0; axis < 3; ++axis) {
    for (int block = 0; block < this->Lattice.count[axis]; ++block) {
      cells[axis][block] = this->cellsAround(brick, axis, block, grid);
    }
  }
  BlockSet seen;
  bool all = true;
  bool none = true;
  glm::ivec3 at;
  for (at.z = 0; at.z < this->Lattice.count.z; ++at.z) {
    for (at.y = 0; at.y < this->Lattice.count.y; ++at.y) {
      for (at.x = 0; at.x < this->Lattice.count.x; ++at.x) {
        const CellSpan& x = cells[0][at.x];
        const CellSpan& y = cells[1][at.y];
        const CellSpan& z = cells[2][at.z];
        if (AnyVisible(grid, {x.first, y.first, z.first}, {x.last, y.last, z.last})) {
          seen.add(at);
          none = false;
        } else {
          all = false;
        }
      }
    }
  }
  return all || none ? BlockSet::all() : seen;
}

} // namespace inr
