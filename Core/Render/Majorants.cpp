// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Majorants.h"

#include "Core/Model/RangeGrids.h"

#include <limits>
#include <utility>

namespace inr {

namespace {

constexpr int EveryLevel = std::numeric_limits<int>::max();

MacroCells WithoutHoles(const MacroCells& cells)
{
  return cells.empty() ? MacroCells{glm::i64vec3(1), glm::dvec3(1.0), {}, {{0.0f, 1.0f}}} : cells;
}

/// The coarsest level whose samples in a cell show nothing beyond the neighbouring cells; below 0
/// where even those of level 0 do.
int CoarsestLevelIn(const MacroCells& cells, const glm::i64vec3& volumeDims)
{
  constexpr double reach = 1.5; // in voxels of the level, which are at most 2^level native ones
  int coarsest = EveryLevel;
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.dims[axis] > 1) {
      const double edge = cells.spacing[axis] * static_cast<double>(volumeDims[axis]);
      coarsest = glm::min(coarsest, static_cast<int>(std::floor(std::log2(edge / reach))));
    }
  }
  return coarsest;
}

} // namespace

Majorants::Majorants(const MacroCells& cells)
{
  this->Grids.push_back({MajorantGrid(WithoutHoles(cells)), EveryLevel});
}

Majorants::Majorants(const MacroCells& cells, const glm::i64vec3& volumeDims, const Arena& arena)
    : Majorants(cells)
{
  if (cells.empty()) {
    return;
  }
  this->Grids.front().coarsestLevel = 0;
  MacroCells ranges = cells;
  while (this->Grids.back().coarsestLevel != EveryLevel) {
    const int coarsest = CoarsestLevelIn(ranges, volumeDims);
    if (coarsest > this->Grids.back().coarsestLevel) {
      this->Grids.push_back({MajorantGrid(Dilated(ranges, arena)), coarsest});
    }
    ranges = Joined(ranges, arena);
  }
}

void Majorants::update(const ColorTable& colors, const Arena& arena)
{
  for (Grid& grid : this->Grids) {
    grid.cells.update(colors, arena);
  }
}

} // namespace inr
