// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Cache/BrickPart.h"
#include "Core/Render/Bricks/VisibleBlocks.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

namespace inr {

/// Those bricks of a cache of which all is known that a picture may look at. Whether a brick is one
/// of them is found out when it is first asked for, by any number of threads.
class SufficientBricks
{
public:
  /// Of pictures that may look at any block of `cache`, which must outlive it, or only at some.
  /// Takes 8 bytes for each slot that is asked for.
  explicit SufficientBricks(const BrickCache& cache,
                            const std::optional<VisibleBlocks>& wanted = std::nullopt);

  const BrickCache& cache() const { return this->Cache; }
  /// Slot of such a brick; PageTable::Unmapped where it is not there or lacks something.
  std::int32_t find(BrickKey key) const
  {
    const std::int32_t slot = this->Cache.find(key);
    return slot != PageTable::Unmapped && this->suffices(slot, key) ? slot : PageTable::Unmapped;
  }
  /// What makes a brick sufficient.
  BlockSet wanted(BrickKey key) const
  {
    return this->Wanted ? this->Wanted->of(key) : BlockSet::all();
  }
  std::vector<BrickPart> wanted(const std::vector<BrickKey>& keys) const
  {
    std::vector<BrickPart> parts;
    parts.reserve(keys.size());
    for (const BrickKey key : keys) {
      parts.emplace_back(key, this->wanted(key));
    }
    return parts;
  }
  bool wantsAll() const { return !this->Wanted; }
  /// Voxels around what can be seen, see VisibleBlocks; 0 where all is wanted.
  int reach() const { return this->Wanted ? this->Wanted->reach() : 0; }

private:
  bool suffices(std::int32_t slot, BrickKey key) const
  {
    const std::uint64_t verdict = this->Verdicts[slot].load(std::memory_order_relaxed);
    const bool isKnown = verdict / 2 == this->Cache.arrival(slot);
    return (isKnown ? verdict : this->judge(slot, key)) % 2 != 0;
  }
  std::uint64_t judge(std::int32_t slot, BrickKey key) const;

  const BrickCache& Cache;
  std::optional<VisibleBlocks> Wanted;
  /// Of each slot, 2 * its brick's arrival + whether that suffices; zeros, until somebody asks.
  ReservedArray<std::atomic<std::uint64_t>> Verdicts;
};

} // namespace inr
