// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickBlocks.h"
#include "Core/Cache/BrickPart.h"
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
/// frames one thread changes what is mapped. Slots that are in use are the first ones, so that
/// memory follows the number of bricks: a brick may change its slot when another is evicted.
class BrickCache
{
public:
  /// That a cache can do its work with: the pinned one, and what a ray looks at before it has come
  /// further, which is a sample's brick, or two, and those of a gradient.
  static constexpr std::int64_t FewestBricks = 8;

  /// Never takes more than `bytes` as bytesFor() counts; the system gives memory by the page.
  /// Throws Error(InvalidArgument) when that does not hold FewestBricks and their tables.
  BrickCache(const Hierarchy& hierarchy, CachePrecision precision, std::int64_t bytes);

  const Hierarchy& hierarchy() const { return this->Levels; }
  CachePrecision precision() const { return this->Pool.precision(); }
  std::int64_t capacity() const { return this->Capacity; } ///< in bricks
  std::int64_t mapped() const { return this->Owners.size(); }
  /// What it takes, at most, while it holds so many bricks.
  std::int64_t bytesFor(std::int64_t bricks) const;
  std::int64_t bytes() const { return this->bytesFor(this->mapped()); }

  /// Slot of a brick, or PageTable::Unmapped.
  std::int32_t find(BrickKey key) const { return this->Table.find(key); }
  BrickView view(std::int32_t slot) const { return this->Pool.view(slot); }
  /// What is known of a slot's brick, block by block.
  const BrickBlocks& blocks() const { return this->Blocks; }
  /// A number above 0 that no other brick has or had, nor the same one when it was here before.
  std::uint64_t arrival(std::int32_t slot) const { return this->Arrivals[slot]; }
  /// Marks a brick as used in this frame.
  void touch(std::int32_t slot) const
  {
    std::atomic<std::uint64_t>& used = this->LastUse[slot];
    // Most touches repeat an earlier one, and reading leaves the line with every core.
    if (used.load(std::memory_order_relaxed) < this->Frame) { // a pinned one is for ever later
      used.store(this->Frame, std::memory_order_relaxed);
    }
  }

  /// Bricks touched or inserted since beginFrame, and pinned ones. Looks at all slots.
  std::int64_t usedInFrame() const;

  /// Bricks touched or inserted from here on are not evicted until the next call. `frame`: later
  /// than all before, and 1.
  void beginFrame(std::uint64_t frame) { this->Frame = frame; }
  /// Touches those used in an earlier frame or after that. Looks at all slots.
  void touchThoseSince(std::uint64_t frame);
  std::uint64_t frame() const { return this->Frame; }
  /// Whether it knows less of a brick than it would with this part.
  bool lacks(const BrickPart& part) const;
  /// Stores and maps a part that it lacks; where the brick is mapped, in its place. `within`: the
  /// range of all of the brick's values, if that is known. Without room, evicts the least recently
  /// used one that is neither of the current frame nor pinned; false, and nothing has changed, when
  /// there is none. Nothing has changed, either, where std::bad_alloc comes; all else takes no
  /// memory.
  bool insert(const BrickPart& part, const float* values, const ValueRange& within = {});
  /// The same of an unmapped brick in the place of another one even where there is room.
  bool replace(const BrickPart& part, const float* values, const ValueRange& within = {});
  /// Keeps a mapped brick for good.
  void pin(BrickKey key);

  static constexpr std::uint64_t Pinned = ~std::uint64_t{0}; ///< later than any frame
  /// Last use of the brick that is evicted next, of those that were last used before `frame`;
  /// Pinned when there is none.
  std::uint64_t oldestUse(std::uint64_t frame);
  /// Evicts that brick, which must exist, and gives its memory back.
  void evict(std::uint64_t frame);
  /// The latest use of all bricks that were ever evicted, 0 when none was.
  std::uint64_t lostUse() const { return this->LostUse; }

  /// Throws Error(InvalidArgument): so many bytes, `where` they are ("on the GPU " or nothing), do
  /// not hold FewestBricks; `least` would.
  [[noreturn]] static void refuse(const Hierarchy& hierarchy, const char* where, std::int64_t bytes,
                                  std::int64_t least);

private:
  static std::int64_t bytesPerBrick(const Hierarchy& hierarchy, CachePrecision precision);
  static std::int64_t capacityFor(const Hierarchy& hierarchy, CachePrecision precision,
                                  std::int64_t bytes);
  std::uint64_t lastUse(std::int32_t slot) const
  {
    return this->LastUse[slot].load(std::memory_order_relaxed);
  }
  /// A slot in the order in which slots are evicted: by last use, then by number. A pinned one's
  /// use, with its upper bits gone, is still later than any frame.
  std::uint64_t candidate(std::int32_t slot) const
  {
    return this->lastUse(slot) << SlotBits | static_cast<std::uint64_t>(slot);
  }
  std::uint64_t lastCandidate(std::uint64_t frame) const;
  void findCandidates(std::uint64_t frame);
  std::int32_t oldest(std::uint64_t frame);
  void unmap(std::int32_t slot);
  void fill(std::int32_t slot, const BrickPart& part, const float* values,
            const ValueRange& within);
  void map(std::int32_t slot, const BrickPart& part, const float* values, const ValueRange& within);
  void move(std::int32_t from, std::int32_t to);
  void resize(std::int64_t slots);

  static constexpr int SlotBits = 25; ///< leaves frames for 17 years at a thousand a second

  Hierarchy Levels;
  std::int64_t Capacity;
  BrickPool Pool;
  BrickBlocks Blocks;
  PageTable Table;
  std::uint64_t Frame = 1;
  std::uint64_t LostUse = 0;
  std::uint64_t Arrived = 0;                         ///< bricks so far
  ReservedArray<BrickKey> Owners;                    ///< of each slot
  ReservedArray<std::uint64_t> Arrivals;             ///< of each slot
  ReservedArray<std::atomic<std::uint64_t>> LastUse; ///< frame in which each slot was last used
  /// The first slots in that order, the very first at the end. Uses only get later, so one not used
  /// since it came in here is still before all others, and all slots are looked at only when the
  /// list has run out.
  std::vector<std::uint64_t> Candidates;
  std::uint64_t NoneBefore = 0; ///< a frame before which no slot was last used
};

} // namespace inr
