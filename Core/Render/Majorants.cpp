// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Majorants.h"

#include "Core/Parallel.h"

namespace inr {

Majorants::Majorants(const MacroCells& cells)
    : Dims(cells.empty() ? glm::i64vec3(1) : cells.dims),
      Spacing(cells.empty() ? glm::dvec3(1.0) : cells.spacing),
      Ranges(cells.empty() ? std::vector<ValueRange>{{0.0f, 1.0f}} : cells.ranges),
      Extinctions(this->Ranges.size(), 0.0f), Empty(this->Dims)
{}

void Majorants::update(const ColorTable& colors, const Arena& arena)
{
  constexpr std::int64_t cellsPerTask = 4096;
  const auto count = static_cast<std::int64_t>(this->Ranges.size());
  arena.forEachBlock(count, cellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const auto cell = static_cast<std::size_t>(k);
      this->Extinctions[cell] = colors.maximumExtinction(this->Ranges[cell]);
    }
  });
  this->Empty.update(this->Extinctions, arena);
}

} // namespace inr
