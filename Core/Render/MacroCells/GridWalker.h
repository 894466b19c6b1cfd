// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/LatticeWalker.h"
#include "Core/Render/MacroCells/MajorantView.h"
#include "Core/Render/Rays/Ray.h"

namespace inr {

/// How large the cells of a grid over a volume are.
struct CellScale
{
  glm::dvec3 edge;     ///< of a cell, in voxels
  glm::dvec3 perVoxel; ///< 1 / edge
};

INR_HOST_DEVICE inline CellScale MakeCellScale(const MajorantGridView& cells,
                                               const glm::dvec3& volumeDims)
{
  const glm::dvec3 edge = volumeDims * cells.spacing();
  return {edge, 1.0 / edge};
}

/// A ray's way through a grid of macro-cells; see LatticeWalker.
class GridWalker
{
public:
  GridWalker() = default; ///< on no ray yet
  /// The grid must outlive it.
  INR_HOST_DEVICE GridWalker(const MajorantGridView& cells, const glm::dvec3& volumeDims,
                             const Ray& ray)
  {
    this->follow(ray, cells, MakeCellScale(cells, volumeDims));
  }
  /// Begins anew on another ray.
  INR_HOST_DEVICE void follow(const Ray& ray, const MajorantGridView& cells, const CellScale& scale)
  {
    this->Cells = &cells;
    this->Way.follow(cells.dims(), (ray.entry + 0.5) * scale.perVoxel,
                     ray.direction * scale.perVoxel, ray.inverse * scale.edge);
  }
  /// Begins anew in another grid.
  INR_HOST_DEVICE void changeTo(const MajorantGridView& cells)
  {
    const glm::dvec3 scale = this->Cells->spacing() / cells.spacing();
    this->Cells = &cells;
    this->Way.changeTo(cells.dims(), scale);
  }

  /// Moves to t, which does not fall from call to call.
  INR_HOST_DEVICE void moveTo(double t)
  {
    this->Way.moveTo(t);
    this->findIndex();
  }

  /// Moves to the first cell from here on that can be seen; false when none begins before `end`.
  INR_HOST_DEVICE bool moveToVisible(double end)
  {
    constexpr int worthwhile = 2; // smaller blocks are left sooner cell by cell
    while (this->extinction() <= 0.0f) {
      const int block = this->Cells->emptyBlock(this->Index);
      if (!(block >= worthwhile ? this->Way.leaveBlock(block, end) : this->Way.moveToNext(end))) {
        return false;
      }
      this->findIndex();
    }
    return true;
  }

  INR_HOST_DEVICE float extinction() const { return this->Cells->extinction(this->Index); }
  INR_HOST_DEVICE const ValueRange& range() const { return this->Cells->range(this->Index); }
  INR_HOST_DEVICE std::int64_t index() const { return this->Index; } ///< of the cell
  INR_HOST_DEVICE const glm::i64vec3& cell() const { return this->Way.cell(); }
  /// Where the ray enters the cell and where it leaves it.
  INR_HOST_DEVICE double enter() const { return this->Way.enter(); }
  INR_HOST_DEVICE double exit() const { return this->Way.exit(); }
  /// Cells looked at so far, on all rays.
  INR_HOST_DEVICE std::int64_t visited() const { return this->Visited; }

private:
  INR_HOST_DEVICE void findIndex()
  {
    this->Index = this->Cells->index(this->Way.cell());
    ++this->Visited;
  }

  const MajorantGridView* Cells = nullptr;
  LatticeWalker Way;
  std::int64_t Index = 0;
  std::int64_t Visited = 0;
};

} // namespace inr
