// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/CellMeasurement.h"

#include "Core/Parallel.h"
#include "Core/Render/Tiles/TileLoop.h"
#include "Core/Timer.h"

#include <algorithm>
#include <atomic>
#include <utility>

namespace inr {

CellMeasurement::CellMeasurement(std::shared_ptr<const Evaluator> field, const glm::i64vec3& dims,
                                 const glm::i64vec3& cells, const glm::dvec3& spacing,
                                 const LineKernel& kernel)
    : Field(std::move(field)), Kernel(kernel), Errors(dims, cells, spacing)
{}

bool CellMeasurement::areTooMany(std::int64_t blocks) const
{
  const std::int64_t cost = this->Errors.blockCost();
  return cost > LargestBlock || blocks > MostVoxels / cost ||
         blocks > MostCells / this->Errors.cellsPerBlock();
}

void CellMeasurement::forgetOthersThan(const std::vector<std::int64_t>& seen)
{
  const std::int64_t blocks =
      this->Errors.measuredBlocks() + static_cast<std::int64_t>(seen.size());
  if (blocks <= MostCells / this->Errors.cellsPerBlock()) {
    return;
  }
  for (std::int64_t block = 0; block < this->Errors.blocks(); ++block) {
    if (!std::binary_search(seen.begin(), seen.end(), block)) {
      this->Errors.forget(block);
    }
  }
}

bool CellMeasurement::measure(const std::vector<std::int64_t>& blocks,
                              const LevelErrors::Question& question, const Arena& arena,
                              const WorkLimit& limit, const std::function<bool()>& keepGoing)
{
  const auto count = static_cast<std::int64_t>(blocks.size());
  const std::int64_t round = limit.isTimed() ? arena.threads() : count;
  for (std::int64_t first = 0; first < count; first += round) {
    if (first > 0 && limit.isTimed() && limit.endsWithin(this->SecondsPerRound)) {
      return false;
    }
    const Timer timer;
    std::atomic<std::int64_t> points{0};
    ForEachTile(arena, std::min(round, count - first), keepGoing, [&](std::int64_t k) {
      points += this->Errors.measure(blocks[static_cast<std::size_t>(first + k)], *this->Field,
                                     this->Kernel, question, [&] { RequireGoing(keepGoing); });
    });
    this->Points += points;
    if (round < count) {
      this->SecondsPerRound = timer.seconds();
    }
  }
  return true;
}

} // namespace inr
