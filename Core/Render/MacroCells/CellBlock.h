// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/CellWalker.h"

#include <glm/common.hpp>

#include <cstdint>

namespace inr {

/// The largest power that CellSampling may have.
constexpr int LargestCellPower = 3;

/// Where a macro-cell's samples come from.
struct CellSampling
{
  std::uint8_t level = 0; ///< of the cache
  std::uint8_t power = 0; ///< they are 2^power steps apart; at least the level
};

/// The macro-cells along a part of a ray, taken together.
struct CellBlock
{
  int level = LargestCellPower; ///< the finest that one of them asks for
  int power = LargestCellPower; ///< and the least
  bool matters = false;         ///< whether one of them can be seen
  ValueRange range;
};

/// Those from where `cells` is up to t = `end`, where it then is. `sampling`: of each cell.
INR_HOST_DEVICE inline CellBlock MeetCells(CellWalker& cells, const CellSampling* sampling,
                                           double end)
{
  CellBlock block;
  while (true) {
    const CellSampling& wanted = sampling[cells.index()];
    block.level = glm::min(block.level, int{wanted.level});
    block.power = glm::min(block.power, int{wanted.power});
    block.matters = block.matters || cells.extinction() > 0.0f;
    block.range.extend(cells.range());
    if (cells.exit() >= end) {
      return block;
    }
    cells.moveTo(cells.exit());
  }
}

} // namespace inr
