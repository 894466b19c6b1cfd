// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Core/Render/CellVisibility.h"
#include "Core/Render/EmptySpace.h"

#include <cstdint>
#include <vector>

namespace inr {

class Arena;

/// A grid of value ranges joined with what makes values visible, a transfer function say.
class MajorantGrid
{
public:
  /// `cells` must not be empty.
  explicit MajorantGrid(MacroCells cells);

  /// Recomputes every cell's extinction: by a rule, or for compositing.
  void update(const ExtinctionRule& rule, const Arena& arena);
  void update(const ColorTable& colors, const Arena& arena)
  {
    this->update(VisibilityFor({}, colors), arena);
  }

  const glm::i64vec3& dims() const { return this->Cells.dims; }
  const glm::dvec3& spacing() const { return this->Cells.spacing; }
  std::int64_t count() const { return static_cast<std::int64_t>(this->Cells.ranges.size()); }
  /// Cells are numbered x fastest.
  std::int64_t index(const glm::i64vec3& at) const { return this->Cells.index(at.x, at.y, at.z); }
  const ValueRange& range(std::int64_t cell) const
  {
    return this->Cells.ranges[static_cast<std::size_t>(cell)];
  }
  /// Where opacity decides, -ln(1 - a) for the largest opacity a (per unit distance) of any value
  /// in the cell's range; 0 = invisible.
  float extinction(std::int64_t cell) const
  {
    return this->Extinctions[static_cast<std::size_t>(cell)];
  }

  /// The largest aligned block of invisible cells around a cell has 2^k cells per axis; -1 = the
  /// cell is visible.
  int emptyBlock(std::int64_t cell) const { return this->Empty.block(cell); }

private:
  MacroCells Cells;
  std::vector<float> Extinctions; ///< apart: empty space is left by looking at nothing else
  EmptySpace Empty;
};

} // namespace inr
