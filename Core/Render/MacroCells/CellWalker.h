// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/GridWalker.h"
#include "Core/Render/MacroCells/MajorantView.h"
#include "Core/Render/Rays/LevelOfDetail.h"

#include <glm/common.hpp>

#include <cstdint>

namespace inr {

/// A ray's way through the macro-cells. Where LevelOfDetail lets samples come from levels too
/// coarse for a grid's cells, the walk goes on in a grid that bounds those. Which cell it is in
/// depends on ray and t only.
class CellWalker
{
public:
  /// `scale` and `levels` are LevelOfDetail's.
  INR_HOST_DEVICE CellWalker(const MajorantsView& majorants, const glm::dvec3& volumeDims,
                             const Ray& ray, double scale, int levels)
      : All(&majorants), LastLevel(levels - 1), Scale(scale)
  {
    this->follow(ray, MakeCellScale(majorants.grid(0), volumeDims));
  }

  /// Begins anew on another ray; `finest` is that of grid 0.
  INR_HOST_DEVICE void follow(const Ray& ray, const CellScale& finest)
  {
    this->Cells.follow(ray, this->All->grid(0), finest);
    this->Footprint = ray.footprint * this->Scale;
    this->Growth = ray.footprintGrowth * this->Scale;
    this->Grid = 0;
    this->End = this->endOf(0);
    while (this->End < 0) {
      this->coarsen();
    }
    this->Begin = 0;
  }

  /// Moves to t, which does not fall from call to call.
  INR_HOST_DEVICE void moveTo(double t)
  {
    while (t >= this->End) {
      this->coarsen();
    }
    this->Cells.moveTo(t);
  }

  /// Moves to the first cell from here on that can be seen; false when none begins before `end`.
  INR_HOST_DEVICE bool moveToVisible(double end)
  {
    while (!this->Cells.moveToVisible(glm::min(end, this->End))) {
      if (this->End >= end) {
        return false;
      }
      this->coarsen();
      this->Cells.moveTo(this->Begin);
    }
    return true;
  }

  INR_HOST_DEVICE std::int64_t index() const { return this->Cells.index(); }
  INR_HOST_DEVICE float extinction() const { return this->Cells.extinction(); }
  INR_HOST_DEVICE const ValueRange& range() const { return this->Cells.range(); }
  /// Where the ray enters the cell, or begins to go by it; and where it leaves it or goes on by
  /// another: the outermost cells reach as far as any ray.
  INR_HOST_DEVICE double enter() const { return glm::max(this->Cells.enter(), this->Begin); }
  INR_HOST_DEVICE double exit() const { return glm::min(this->Cells.exit(), this->End); }
  /// Cells looked at so far, on all rays.
  INR_HOST_DEVICE std::int64_t visited() const { return this->Cells.visited(); }

private:
  /// t up to which a grid bounds what LevelOfDetail chooses.
  INR_HOST_DEVICE double endOf(int grid) const
  {
    const int level = this->All->coarsestLevel(grid);
    if (level >= this->LastLevel) {
      return Infinite;
    }
    constexpr double early = 1.0 - 1e-12; // whatever rounding says
    const double largest =
        early * LevelOfDetail::MixedFrom * static_cast<double>(std::int64_t{1} << level);
    if (this->Footprint > largest) {
      return -1;
    }
    return this->Growth > 0 ? (largest - this->Footprint) / this->Growth : Infinite;
  }

  INR_HOST_DEVICE void coarsen()
  {
    this->Begin = this->End;
    this->Cells.changeTo(this->All->grid(++this->Grid));
    this->End = this->endOf(this->Grid);
  }

  const MajorantsView* All;
  GridWalker Cells;
  double Footprint = 0;
  double Growth = 0;
  int LastLevel;
  int Grid = 0;
  double Begin = 0; ///< t from which the grid is gone by
  double End = 0;   ///< and up to which
  double Scale;     ///< of footprints
};

} // namespace inr
