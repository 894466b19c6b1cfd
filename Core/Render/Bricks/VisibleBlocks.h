// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickPart.h"
#include "Core/Cache/Hierarchy.h"
#include "Core/Render/MacroCells/MajorantView.h"

namespace inr {

/// The blocks of bricks that rays can see something in. Between the voxels of the others all is
/// invisible, if the ranges of the macro-cells hold (Majorants::rangesHold).
///
/// These are the blocks that touch a visible cell, one of the finest grid that bounds samples of
/// the brick's level: where a coarser grid leads a ray to further places, what that level has there
/// is within the range of a cell that is invisible.
class VisibleBlocks
{
public:
  /// `reach`: voxels of the brick's level around such a cell, within which something else is looked
  /// at. The references must outlive it.
  VisibleBlocks(const Hierarchy& hierarchy, const MajorantsView& majorants, int reach)
      : Levels(hierarchy), Lattice(hierarchy.brickDims()), Cells(majorants), Reach(reach)
  {}

  /// All where there are none: somebody asks for the brick nevertheless.
  BlockSet of(BrickKey key) const;

  int reach() const { return this->Reach; }

private:
  struct CellSpan
  {
    std::int64_t first;
    std::int64_t last; ///< below `first`: of none
  };

  CellSpan cellsAround(const BrickId& brick, int axis, int block,
                       const MajorantGridView& grid) const;

  const Hierarchy& Levels;
  BlockLattice Lattice;
  const MajorantsView& Cells;
  int Reach;
};

} // namespace inr
