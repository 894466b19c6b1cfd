// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/LevelChooser.h"

#include "Core/Render/CellBlock.h"
#include "Core/Render/TileLoop.h"
#include "Core/Render/Timer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

namespace inr {

namespace {

constexpr std::int64_t CellsPerTask = 4096;
static_assert(LevelErrors::Coarsest <= CoarsestCellLevel, "rays go by blocks of that size");

/// Of a tolerance, what the cells along a ray may come to if they err independently.
constexpr double Share = 4.0;

/// Of a step whose value may be anything in a range.
double LargestError(const ColorSensitivity::Slopes& slopes, const ValueRange& range)
{
  return range.empty() ? 0.0 : (slopes.middle + slopes.half) * (range.high - range.low);
}

} // namespace

LevelChooser::LevelChooser(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
                           const MajorantGrid& cells, int levels)
    : Field(std::move(field)), Errors(dims, cells.dims(), cells.spacing()),
      Coarsest(std::min(levels - 1, LevelErrors::Coarsest)),
      Slopes(static_cast<std::size_t>(cells.count())),
      Levels(static_cast<std::size_t>(cells.count()), 0)
{}

LevelChooser::Outcome LevelChooser::choose(const Wish& wish, const MajorantGrid& cells,
                                           const ColorLookup& colors, const Arena& arena,
                                           const WorkLimit& limit,
                                           const std::function<bool()>& keepGoing)
{
  const bool known = this->Chosen && *this->Chosen == wish;
  if (known && this->Complete) {
    return Outcome::Same;
  }
  if (!known) {
    this->Chosen.reset(); // should measuring be stopped
    this->findSlopes(wish, cells, colors, arena);
  }
  this->Complete =
      this->measure(this->unmeasured(cells, this->allowance(wish)), arena, limit, keepGoing);
  this->chooseLevels(wish, cells, arena);
  this->Chosen = wish;
  return this->Complete ? Outcome::Changed : Outcome::Partial;
}

void LevelChooser::findSlopes(const Wish& wish, const MajorantGrid& cells,
                              const ColorLookup& colors, const Arena& arena)
{
  const ColorSensitivity sensitivity(colors, wish.stepLength);
  const auto count = static_cast<std::int64_t>(this->Slopes.size());
  arena.forEachBlock(count, CellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t cell = begin; cell < end; ++cell) {
      this->Slopes[static_cast<std::size_t>(cell)] = sensitivity.slopes(cells.range(cell));
    }
  });
}

double LevelChooser::allowance(const Wish& wish) const
{
  const glm::dvec3& edge = this->Errors.cellEdge();
  const double steps = std::max(1.0, std::min({edge.x, edge.y, edge.z}) / wish.step); // of a cell
  const double cells = std::max(1.0, wish.steps / steps);
  return Share * wish.tolerance / (steps * std::sqrt(cells));
}

std::vector<std::int64_t> LevelChooser::unmeasured(const MajorantGrid& cells,
                                                   double allowance) const
{
  std::vector<char> wanted(static_cast<std::size_t>(this->Errors.blocks()), 0);
  for (std::int64_t cell = 0; cell < cells.count(); ++cell) {
    const ColorSensitivity::Slopes& slopes = this->Slopes[static_cast<std::size_t>(cell)];
    if (cells.extinction(cell) > 0.0f && std::isfinite(slopes.half) &&
        LargestError(slopes, cells.range(cell)) > allowance) {
      wanted[static_cast<std::size_t>(this->Errors.blockOf(cell))] = 1;
    }
  }
  std::vector<std::int64_t> blocks;
  for (std::int64_t block = 0; block < this->Errors.blocks(); ++block) {
    if (wanted[static_cast<std::size_t>(block)] != 0 && !this->Errors.isMeasured(block)) {
      blocks.push_back(block);
    }
  }
  const std::int64_t cost = this->Errors.blockCost();
  const bool tooMany =
      cost > LargestBlock || static_cast<std::int64_t>(blocks.size()) > MostVoxels / cost;
  return tooMany ? std::vector<std::int64_t>{} : blocks;
}

bool LevelChooser::measure(const std::vector<std::int64_t>& blocks, const Arena& arena,
                           const WorkLimit& limit, const std::function<bool()>& keepGoing)
{
  const auto count = static_cast<std::int64_t>(blocks.size());
  const std::int64_t round = limit.isTimed() ? arena.threads() : count;
  for (std::int64_t first = 0; first < count; first += round) {
    if (limit.isTimed() && limit.endsWithin(this->SecondsPerRound)) {
      return false;
    }
    const Timer timer;
    std::atomic<std::int64_t> points{0};
    ForEachTile(arena, std::min(round, count - first), keepGoing, [&](std::int64_t k) {
      points += this->Errors.measure(blocks[static_cast<std::size_t>(first + k)], *this->Field);
    });
    this->Points += points;
    if (round < count) {
      this->SecondsPerRound = timer.seconds();
    }
  }
  return true;
}

void LevelChooser::chooseLevels(const Wish& wish, const MajorantGrid& cells, const Arena& arena)
{
  const auto count = static_cast<std::int64_t>(this->Levels.size());
  const double allowance = this->allowance(wish);
  arena.forEachBlock(count, CellsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t cell = begin; cell < end; ++cell) {
      this->Levels[static_cast<std::size_t>(cell)] =
          static_cast<std::uint8_t>(this->levelOf(cell, cells.range(cell), wish, allowance));
    }
  });
}

double LevelChooser::errorOf(std::int64_t cell, int level, double step) const
{
  const ColorSensitivity::Slopes& slopes = this->Slopes[static_cast<std::size_t>(cell)];
  const LevelErrors::Error& error = this->Errors.error(cell, level);
  // The middle of n steps differs from their mean by n^2/24 of the curvature, of which the level
  // itself leaves out n^2/8; and from each of them by n/4 of the slope in the mean.
  const double mean = error.mean * (1.0 + step * step / 3.0);
  const double spread = error.spread + this->Errors.slope(cell) * step * (1 << level) / 4.0;
  return slopes.middle * mean + slopes.half * spread;
}

int LevelChooser::levelOf(std::int64_t cell, const ValueRange& range, const Wish& wish,
                          double allowance) const
{
  const ColorSensitivity::Slopes& slopes = this->Slopes[static_cast<std::size_t>(cell)];
  if (!std::isfinite(slopes.half)) {
    return 0;
  }
  if (LargestError(slopes, range) <= allowance) {
    return this->Coarsest;
  }
  if (!this->Errors.isMeasured(this->Errors.blockOf(cell))) {
    return 0;
  }
  int level = this->Coarsest;
  while (level > 0 && this->errorOf(cell, level, wish.step) > allowance) {
    --level;
  }
  return level;
}

} // namespace inr
