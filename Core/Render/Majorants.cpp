// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Majorants.h"

#include "Core/Parallel.h"

#include <cmath>

namespace inr {

Majorants::Majorants(const MacroCells& cells)
    : Dims(cells.empty() ? glm::i64vec3(1) : cells.dims),
      Spacing(cells.empty() ? glm::dvec3(1.0) : cells.spacing)
{
  if (cells.empty()) {
    this->Cells.push_back({ValueRange{0.0f, 1.0f}});
    return;
  }
  this->Cells.reserve(cells.ranges.size());
  for (const ValueRange& range : cells.ranges) {
    this->Cells.push_back({range});
  }
}

void Majorants::update(const ColorTable& colors, const Arena& arena)
{
  constexpr std::int64_t cellsPerTask = 4096;
  const auto count = static_cast<std::int64_t>(this->Cells.size());
  arena.forEachBlock(count, cellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      MajorantCell& cell = this->Cells[static_cast<std::size_t>(k)];
      cell.extinction = -std::log1p(-colors.maximumOpacity(cell.range));
    }
  });
}

} // namespace inr
