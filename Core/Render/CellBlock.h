// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/CellWalker.h"

#include <glm/common.hpp>

#include <cstdint>

namespace inr {

/// The coarsest level that a macro-cell may ask for.
constexpr int CoarsestCellLevel = 3;

/// The macro-cells along a part of a ray, taken together.
struct CellBlock
{
  int level = CoarsestCellLevel; ///< the finest that one of them asks for
  bool matters = false;          ///< whether one of them can be seen
  ValueRange range;

  INR_HOST_DEVICE void extend(const ValueRange& other)
  {
    if (!other.empty()) {
      this->range.extend(other.low);
      this->range.extend(other.high);
    }
  }
};

/// Those from where `cells` is up to t = `end`, where it then is. `levels`: of each cell.
INR_HOST_DEVICE inline CellBlock MeetCells(CellWalker& cells, const std::uint8_t* levels,
                                           double end)
{
  CellBlock block;
  while (true) {
    block.level = glm::min(block.level, int{levels[cells.index()]});
    block.matters = block.matters || cells.extinction() > 0.0f;
    block.extend(cells.range());
    if (cells.exit() >= end) {
      return block;
    }
    cells.moveTo(cells.exit());
  }
}

} // namespace inr
