// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MacroCells/Majorants.h"

#include "Core/Error.h"
#include "Core/Model/RangeGrids.h"
#include "Core/NumberText.h"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace inr {

namespace {

constexpr int EveryLevel = std::numeric_limits<int>::max();

MacroCells WithoutHoles(const MacroCells& cells)
{
  return cells.empty() ? MacroCells{glm::i64vec3(1), glm::dvec3(1.0), {}, {}, {{0.0f, 1.0f}}}
                       : cells;
}

void RequireFinite(const ValueRange& range, std::size_t cell)
{
  if (!std::isfinite(range.low) || !std::isfinite(range.high)) {
    throw Error(ErrorCode::InvalidArgument,
                "macro-cell " + std::to_string(cell) + " has values from " + NumberText(range.low) +
                    " to " + NumberText(range.high) + "; both have to be finite numbers");
  }
}

/// The coarsest level whose samples in a cell show nothing that is further than `distance` (in the
/// unit cube) from it; below 0 where even those of level 0 do.
int CoarsestLevelWithin(const glm::dvec3& distance, const MacroCells& cells,
                        const glm::i64vec3& volumeDims)
{
  constexpr double reach = 1.25; // in voxels of the level, which are at most 2^level native ones
  double levels = EveryLevel;
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.dims[axis] > 1) {
      const double voxels = distance[axis] * static_cast<double>(volumeDims[axis]);
      levels = glm::min(levels, std::floor(std::log2(glm::max(voxels, 0.1) / reach)));
    }
  }
  return static_cast<int>(levels);
}

} // namespace

Majorants::Majorants(const MacroCells& cells) : RangesHold(cells.rangesHold())
{
  const MacroCells whole = WithoutHoles(cells);
  for (std::size_t cell = 0; cell < whole.ranges.size(); ++cell) {
    const ValueRange& range = whole.ranges[cell];
    RequireFinite(range, cell);
    this->Bounds.extend(range);
  }
  this->add(whole, EveryLevel);
}

Majorants::Majorants(const MacroCells& cells, const glm::i64vec3& volumeDims, const Arena& arena)
    : Majorants(cells)
{
  if (cells.empty()) {
    return;
  }
  int reached = glm::max(0, CoarsestLevelWithin(cells.apron, cells, volumeDims));
  this->View.boundTo(0, reached);
  MacroCells ranges = cells;
  while (reached != EveryLevel) {
    const int coarsest = CoarsestLevelWithin(ranges.spacing, ranges, volumeDims);
    if (coarsest > reached) {
      this->add(Dilated(ranges, arena), coarsest);
      reached = coarsest;
    }
    ranges = Joined(ranges, arena);
  }
}

void Majorants::add(MacroCells cells, int coarsestLevel)
{
  this->Grids.emplace_back(std::move(cells));
  this->View.add(this->Grids.back().view(), coarsestLevel);
}

void Majorants::update(const ColorTable& colors, const Arena& arena)
{
  this->update(VisibilityFor({}, colors), arena);
}

void Majorants::update(const ExtinctionRule& rule, const Arena& arena)
{
  for (MajorantGrid& grid : this->Grids) {
    grid.update(rule, arena);
  }
}

} // namespace inr
