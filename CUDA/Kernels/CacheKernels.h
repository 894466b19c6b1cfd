// SPDX-License-Identifier: BSD-3-Clause
//
// What changes a cache between frames.
#pragma once

#include "CUDA/Kernels/BrickGeometry.h"
#include "CUDA/Kernels/CacheRanking.h"
#include "Core/Cache/Quantisation.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// What the host is told of a round.
struct CacheCounts
{
  RequestCounts requests; ///< by now
  RequestCounts listed;   ///< when bricks were listed
  std::int64_t wanted;    ///< bricks, at most as many as may come in
  BrickEnd end;           ///< of what is inferred: as many as there are slots for
  std::uint64_t stored;   ///< bricks
  std::uint64_t marked;   ///< voxels of them that are no numbers
};

constexpr int CacheThreads = 256; ///< of a block

/// Forgets all wishes.
struct ClearRequests
{
  static constexpr int Threads = CacheThreads;

  RequestTable table;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const std::int64_t first = std::int64_t{block.index()} * Threads + thread;
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      for (std::int64_t k = first; k <= this->table.mask; k += stride) {
        this->table.entries[k] = {NoBrick, 0};
      }
      if (first == 0) {
        *this->table.counts = {0, 0};
      }
    });
  }
};

/// Lists what is to be inferred: wanted bricks, as long as there are slots for them. By the first
/// block.
struct ListBricks
{
  static constexpr int Threads = CacheThreads;
  static constexpr std::int64_t SharedBytes = 2 * MostSelected * sizeof(std::int64_t);

  HierarchyView levels;
  const RankEntry* bricks; ///< see WantedBricks; None behind the last
  const RankEntry* slots;  ///< see ReplaceableSlots; None behind the last
  std::int64_t most;       ///< entries of both, at most MostSelected
  BrickJob* jobs;
  CacheCounts* counts;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    if (block.index() > 0) {
      return;
    }
    const std::int64_t* const items = this->sumItems(block);
    block.threads([&](int thread) {
      if (thread == 0) {
        this->count(items);
      }
      for (std::int64_t k = thread; k < this->most && this->isListed(k); k += Threads) {
        this->jobs[k] = this->job(k, k > 0 ? items[k - 1] : 0);
      }
    });
  }

private:
  INR_HOST_DEVICE bool isListed(std::int64_t k) const
  {
    return !this->bricks[k].isNone() && !this->slots[k].isNone();
  }
  INR_HOST_DEVICE std::int64_t voxels() const ///< of a brick
  {
    const glm::ivec3& dims = this->levels.brickDims();
    return std::int64_t{1} * dims.x * dims.y * dims.z;
  }
  INR_HOST_DEVICE BrickJob job(std::int64_t k, std::int64_t firstItem) const
  {
    return JobOf(this->levels, WantedBricks::KeyOf(this->bricks[k]), 0, this->levels.brickDims().z,
                 {k, firstItem, k * this->voxels()});
  }

  INR_HOST_DEVICE void count(const std::int64_t* items) const
  {
    const std::int64_t wanted = Length(this->bricks, this->most);
    const std::int64_t places = Length(this->slots, this->most);
    const std::int64_t listed = wanted < places ? wanted : places;
    this->counts->listed = this->counts->requests;
    this->counts->wanted = wanted;
    this->counts->end = {listed, listed > 0 ? items[listed - 1] : 0, listed * this->voxels()};
    this->counts->stored = 0;
    this->counts->marked = 0;
  }

  INR_HOST_DEVICE static std::int64_t Length(const RankEntry* entries, std::int64_t most)
  {
    std::int64_t low = 0;
    for (std::int64_t high = most; low < high;) {
      const std::int64_t middle = low + (high - low) / 2;
      (entries[middle].isNone() ? high : low) = entries[middle].isNone() ? middle : middle + 1;
    }
    return low;
  }

  /// Items of all listed bricks up to and with each one. Phases.
  template <class Block> INR_HOST_DEVICE const std::int64_t* sumItems(Block& block) const
  {
    std::int64_t* sums = reinterpret_cast<std::int64_t*>(block.shared());
    std::int64_t* next = sums + MostSelected;
    block.threads([&](int thread) {
      for (std::int64_t k = thread; k < this->most; k += Threads) {
        sums[k] = this->isListed(k) ? ItemsOf(this->job(k, 0)) : 0;
      }
    });
    for (std::int64_t reach = 1; reach < this->most; reach *= 2) {
      block.threads([&](int thread) {
        for (std::int64_t k = thread; k < this->most; k += Threads) {
          next[k] = sums[k] + (k >= reach ? sums[k - reach] : 0);
        }
      });
      std::int64_t* const done = next;
      next = sums;
      sums = done;
    }
    return sums;
  }
};

/// Puts inferred bricks into slots, the first one into the first, to the last bit as Core's
/// BrickPool keeps them, but that a lowest value of zero is never a negative one. A block for each.
struct StoreBricks
{
  static constexpr int Threads = CacheThreads;

  struct Range
  {
    float low;
    float high;
    std::uint32_t marked;
  };
  static constexpr std::int64_t SharedBytes = Threads * sizeof(Range);

  CacheView cache;
  const RankEntry* bricks;
  const RankEntry* slots;
  const float* values; ///< of bricks behind each other
  CacheCounts* counts;
  std::uint32_t* marked; ///< voxels of each brick that are no numbers: Core has to compute them

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    const BrickEnd end = this->counts->end;
    for (std::int64_t k = block.index(); k < end.jobs; k += block.count()) {
      if (this->slots[k].isNone()) {
        return; // nor is there one for those behind
      }
      const std::int64_t voxels = end.values / end.jobs;
      const float* const brick = this->values + k * voxels;
      const Range* const range = FindRange(block, brick, voxels);
      block.threads([&](int thread) {
        const BrickScale scale = this->scaleOf(range->low, range->high);
        if (thread == 0) {
          this->enter(k, scale, range->marked);
        }
        this->store(this->slot(k), brick, voxels, scale, thread);
      });
    }
  }

private:
  INR_HOST_DEVICE std::int64_t slot(std::int64_t k) const
  {
    return static_cast<std::int64_t>(this->slots[k].minor);
  }

  INR_HOST_DEVICE void enter(std::int64_t k, const BrickScale& scale, std::uint32_t marked) const
  {
    const std::int64_t slot = this->slot(k);
    this->cache.owners[slot] = WantedBricks::KeyOf(this->bricks[k]);
    this->cache.uses[slot] = this->cache.frame;
    this->cache.scales[slot] = scale;
    this->marked[k] = marked;
    AtomicAdd(this->counts->stored, std::uint64_t{1});
    if (marked > 0) {
      AtomicAdd(this->counts->marked, std::uint64_t{marked});
    }
  }

  INR_HOST_DEVICE static Range Joined(const Range& a, const Range& b)
  {
    return {b.low < a.low ? b.low : a.low, b.high > a.high ? b.high : a.high, a.marked + b.marked};
  }

  /// Of NaNs, if they are all that there is. Phases.
  template <class Block>
  INR_HOST_DEVICE static const Range* FindRange(Block& block, const float* values,
                                                std::int64_t count)
  {
    Range* const ranges = reinterpret_cast<Range*>(block.shared());
    block.threads([&](int thread) {
      Range range{values[0], values[0], 0};
      for (std::int64_t k = thread; k < count; k += Threads) {
        const float value = values[k];
        range = Joined(range, {value, value, value != value ? 1u : 0u});
      }
      ranges[thread] = range;
    });
    for (int half = Threads / 2; half > 0; half /= 2) {
      block.threads([&](int thread) {
        if (thread < half) {
          ranges[thread] = Joined(ranges[thread], ranges[thread + half]);
        }
      });
    }
    return ranges;
  }

  INR_HOST_DEVICE BrickScale scaleOf(float low, float high) const
  {
    if (this->cache.precision == CachePrecision::Float32) {
      return {0.0f, 1.0f};
    }
    const bool wide = this->cache.precision == CachePrecision::Bits16;
    // Which of two zeros came first is the threads' affair.
    return {low == 0.0f ? 0.0f : low, StepOf(low, high, wide ? 65535.0f : 255.0f)};
  }

  INR_HOST_DEVICE void store(std::int64_t slot, const float* values, std::int64_t count,
                             const BrickScale& scale, int thread) const
  {
    unsigned char* const to = this->cache.voxels + slot * this->cache.bytesPerBrick;
    switch (this->cache.precision) {
    case CachePrecision::Float32:
      for (std::int64_t k = thread; k < count; k += Threads) {
        reinterpret_cast<float*>(to)[k] = values[k];
      }
      return;
    case CachePrecision::Bits16:
      return Quantise<std::uint16_t>(to, values, count, scale, thread);
    case CachePrecision::Bits8:
      return Quantise<std::uint8_t>(to, values, count, scale, thread);
    }
  }

  template <class Stored>
  INR_HOST_DEVICE static void Quantise(unsigned char* to, const float* values, std::int64_t count,
                                       const BrickScale& scale, int thread)
  {
    const float inverse = InverseOf(scale.step);
    for (std::int64_t k = thread; k < count; k += Threads) {
      reinterpret_cast<Stored*>(to)[k] = Quantised<Stored>(values[k], scale.low, inverse);
    }
  }
};

/// Enters all slots that are in use into a page table of free entries.
struct MapSlots
{
  static constexpr int Threads = CacheThreads;

  CacheView cache;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      for (std::int64_t slot = std::int64_t{block.index()} * Threads + thread;
           slot < this->cache.capacity; slot += stride) {
        if (this->cache.uses[slot] > 0) {
          this->enter(this->cache.owners[slot], slot);
        }
      }
    });
  }

private:
  INR_HOST_DEVICE void enter(BrickKey key, std::int64_t slot) const
  {
    auto place = static_cast<std::uint32_t>(MixBits(key)) & this->cache.pageMask;
    while (AtomicExchangeIf(this->cache.pages[place].key, NoBrick, key) != NoBrick) {
      place = (place + 1) & this->cache.pageMask;
    }
    this->cache.pages[place].slot = slot;
  }
};

} // namespace cuda
} // namespace inr
