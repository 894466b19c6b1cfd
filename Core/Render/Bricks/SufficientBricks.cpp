// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/SufficientBricks.h"

namespace inr {

SufficientBricks::SufficientBricks(const BrickCache& cache,
                                   const std::optional<VisibleBlocks>& wanted)
    : Cache(cache), Wanted(wanted), Verdicts(cache.capacity())
{
  this->Verdicts.resize(cache.capacity());
}

std::uint64_t SufficientBricks::judge(std::int32_t slot, BrickKey key) const
{
  const BlockSet& known = this->Cache.blocks().known(slot);
  const bool suffices = known.isAll() || known.contains(this->wanted(key));
  const std::uint64_t verdict = 2 * this->Cache.arrival(slot) + (suffices ? 1 : 0);
  this->Verdicts[slot].store(verdict,
                             std::memory_order_relaxed); // whoever else is here finds the same
  return verdict;
}

} // namespace inr
