// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickPool.h"
#include "Core/Cache/PageTable.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace inr {

/// Bricks of normalised values, as many as a budget of memory holds; the least recently used one
/// makes room for the next.
///
/// Time runs in frames. During a frame any number of threads may find, view and touch; between
/// frames one thread changes what is mapped.
class BrickCache
{
public:
  /// Everything is allocated within `bytes`. Throws Error(InvalidArgument) when that does not hold
  /// 8 bricks and their tables.
  BrickCache(const Hierarchy& hierarchy, CachePrecision precision, std::int64_t bytes);

  const Hierarchy& hierarchy() const { return this->Levels; }
  CachePrecision precision() const { return this->Pool.precision(); }
  std::int64_t capacity() const { return this->Pool.slots(); } ///< in bricks
  std::int64_t mapped() const { return this->Mapped; }
  std::int64_t bytes() const; ///< of all that is allocated

  /// Slot of a brick, or PageTable::Unmapped.
  std::int32_t find(BrickKey key) const { return this->Table.find(key); }
  BrickView view(std::int32_t slot) const { return this->Pool.view(slot); }
  /// Marks a brick as used in this frame.
  void touch(std::int32_t slot) const
  {
    std::atomic<std::uint64_t>& used = this->LastUse[static_cast<std::size_t>(slot)];
    // Most touches repeat an earlier one, and reading leaves the line with every core.
    if (used.load(std::memory_order_relaxed) < this->Frame) { // a pinned one is for ever later
      used.store(this->Frame, std::memory_order_relaxed);
    }
  }

  /// Bricks touched or inserted since beginFrame, and pinned ones. Looks at all slots.
  std::int64_t usedInFrame() const;

  /// Bricks touched or inserted from here on are not evicted until the next call.
  void beginFrame();
  /// Stores and maps an unmapped brick. Evicts the least recently used one that is neither of the
  /// current frame nor pinned; false, and nothing has changed, when there is none.
  bool insert(BrickKey key, const float* values);
  /// Keeps a mapped brick for good.
  void pin(BrickKey key);

private:
  static std::int64_t bytesFor(const Hierarchy& hierarchy, CachePrecision precision,
                               std::int64_t bricks);
  static std::int64_t capacityFor(const Hierarchy& hierarchy, CachePrecision precision,
                                  std::int64_t bytes);
  std::uint64_t lastUse(std::int32_t slot) const
  {
    return this->LastUse[static_cast<std::size_t>(slot)].load(std::memory_order_relaxed);
  }
  /// A slot in the order in which slots are evicted: by last use, then by number. A pinned one's
  /// use, with its upper bits gone, is still later than any frame.
  std::uint64_t candidate(std::int32_t slot) const
  {
    return this->lastUse(slot) << SlotBits | static_cast<std::uint64_t>(slot);
  }
  std::uint64_t lastCandidate() const;
  std::int32_t freeSlot();
  void findCandidates();

  static constexpr std::uint64_t Pinned = ~std::uint64_t{0};
  static constexpr BrickKey NoBrick = ~BrickKey{0};
  static constexpr int SlotBits = 25; ///< leaves frames for 17 years at a thousand a second

  Hierarchy Levels;
  BrickPool Pool;
  PageTable Table;
  std::uint64_t Frame = 1;
  std::int64_t Mapped = 0;
  std::vector<BrickKey> Owners; ///< of each slot
  /// Frame in which each slot was last used, 0 = empty.
  std::unique_ptr<std::atomic<std::uint64_t>[]> LastUse;
  /// The first slots in that order, the very first at the end. Uses only get later, so one not used
  /// since it came in here is still before all others, and all slots are looked at only when the
  /// list has run out.
  std::vector<std::uint64_t> Candidates;
  std::uint64_t ExhaustedIn = 0; ///< frame in which nothing can be evicted any more
};

} // namespace inr
