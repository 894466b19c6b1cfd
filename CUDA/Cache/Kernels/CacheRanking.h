// SPDX-License-Identifier: BSD-3-Clause
//
// Which bricks come into a cache, and in whose place.
#pragma once

#include "CUDA/Cache/Kernels/CacheView.h"
#include "CUDA/Cache/Kernels/Selection.h"

namespace inr {
namespace cuda {

/// Wanted bricks that are not mapped, in the order of Core's RequestRanking: by falling
/// contribution, coarser levels, then smaller keys first among equals.
struct WantedBricks
{
  CacheView cache;
  bool byContribution; ///< else by level and key only: threads at once want nothing first

  INR_HOST_DEVICE RankEntry operator()(std::int64_t k) const
  {
    const RequestEntry& wish = this->cache.requests.entries[k];
    if (wish.key == NoBrick || this->cache.find(wish.key) != CacheView::Unmapped) {
      return RankEntry::None();
    }
    constexpr std::uint64_t most = RequestTable::Saturated;
    const std::uint64_t sum = wish.contribution < most ? wish.contribution : most;
    return {this->byContribution ? most - sum : 0, Flipped(wish.key)};
  }

  INR_HOST_DEVICE static BrickKey KeyOf(const RankEntry& entry) { return Flipped(entry.minor); }
  INR_HOST_DEVICE static RankEntry EntryOf(BrickKey key) { return {0, Flipped(key)}; }

private:
  /// With levels in falling order; its own inverse.
  INR_HOST_DEVICE static BrickKey Flipped(BrickKey key)
  {
    constexpr BrickKey levels = BrickKey{31} << (3 * BrickAxisBits);
    return key ^ levels;
  }
};

/// Slots that may take another brick: free ones, then the least recently used, of equal ones the
/// first; none that the present frame has used, nor the first `pinned` ones.
struct ReplaceableSlots
{
  const std::uint64_t* uses;
  std::uint64_t frame;
  std::int64_t pinned;

  INR_HOST_DEVICE RankEntry operator()(std::int64_t k) const
  {
    const bool mayGo = k >= this->pinned && this->uses[k] < this->frame;
    return mayGo ? RankEntry{this->uses[k], static_cast<std::uint64_t>(k)} : RankEntry::None();
  }
};

} // namespace cuda
} // namespace inr
