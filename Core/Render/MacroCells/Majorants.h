// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MacroCells/MajorantGrid.h"

#include <vector>

namespace inr {

/// Value ranges joined with a transfer function, for samples of every cache level.
///
/// A sample of level l shows what is within 1.25 voxels of that level: between it and the centre of
/// the furthest voxel that it is interpolated from lies one, and that voxel may be the mean of
/// points a quarter of a voxel from its centre. Samples of level 0, and of as many others as the
/// apron of the model's own cells is wide enough for, go by these (grid 0). Those of coarser levels
/// go by grids whose cells, of a power of two times that size, are at least so large and bound all
/// that their neighbours do too.
class Majorants
{
public:
  /// For samples of level 0 only. Space without a range table (files that lack one) is one cell
  /// that may hold anything. Throws Error(InvalidArgument) where a range is not finite.
  explicit Majorants(const MacroCells& cells);
  /// For all levels, in time proportional to the cells.
  Majorants(const MacroCells& cells, const glm::i64vec3& volumeDims, const Arena& arena);
  Majorants(Majorants&&) noexcept = default;
  Majorants& operator=(Majorants&&) noexcept = default;

  /// Recomputes every cell's extinction: for compositing, or by a rule.
  void update(const ColorTable& colors, const Arena& arena);
  void update(const ExtinctionRule& rule, const Arena& arena);

  /// Of all values; empty when there are none.
  const ValueRange& bounds() const { return this->Bounds; }
  bool rangesHold() const { return this->RangesHold; } ///< see MacroCells

  int grids() const { return static_cast<int>(this->Grids.size()); }
  const MajorantGrid& grid(int number) const
  {
    return this->Grids[static_cast<std::size_t>(number)];
  }
  /// The coarsest level that a grid bounds; it bounds all finer ones too. The last grid bounds all.
  int coarsestLevel(int grid) const { return this->View.coarsestLevel(grid); }
  /// What walks read, for as long as this lives, or what it is moved to.
  const MajorantsView& view() const { return this->View; }

private:
  void add(MacroCells cells, int coarsestLevel);

  std::vector<MajorantGrid> Grids;
  MajorantsView View; ///< of these
  ValueRange Bounds;
  bool RangesHold;
};

} // namespace inr
