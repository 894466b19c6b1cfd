// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MacroCells/MajorantGrid.h"

#include "Core/Parallel.h"

#include <utility>

namespace inr {

MajorantGrid::MajorantGrid(MacroCells cells)
    : Cells(std::move(cells)), Extinctions(this->Cells.ranges.size(), 0.0f),
      Empty(this->Cells.dims),
      View(this->Cells.dims, this->Cells.spacing, this->Cells.ranges.data(),
           this->Extinctions.data(), this->Empty.blocks())
{}

void MajorantGrid::update(const ExtinctionRule& rule, const Arena& arena)
{
  constexpr std::int64_t cellsPerTask = 4096;
  const auto count = static_cast<std::int64_t>(this->Extinctions.size());
  arena.forEachBlock(count, cellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    rule(this->Cells.ranges.data() + begin, end - begin, this->Extinctions.data() + begin);
  });
  this->Empty.update(this->Extinctions, arena);
}

} // namespace inr
