// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/Kernels/ListBricks.h"
#include "Core/Cache/BrickCells.h"
#include "Core/Cache/Quantisation.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Puts inferred bricks into slots, the first one into the first, to the last bit as Core's
/// BrickPool keeps them, but that a lowest value of zero is never a negative one. A block for each.
struct StoreBricks
{
  static constexpr int Threads = 256;

  struct Range
  {
    float low;
    float high;
    std::uint32_t marked;
    ValueRange within; ///< of the cells
  };
  static constexpr std::int64_t SharedBytes = Threads * sizeof(Range);

  CacheView cache;
  const RankEntry* bricks;
  const RankEntry* slots;
  const float* values; ///< of bricks behind each other
  CacheCounts* counts;
  std::uint32_t* marked; ///< voxels of each brick that are no numbers: Core has to compute them
  CellTable cells;       ///< normalised; integers divide what those of a brick span

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    const BrickEnd end = this->counts->end;
    for (std::int64_t k = block.index(); k < end.jobs; k += block.count()) {
      if (this->slots[k].isNone()) {
        return; // nor is there one for those behind
      }
      const std::int64_t voxels = end.values / end.jobs;
      const float* const brick = this->values + k * voxels;
      const Range* const range = this->findRange(block, k, brick, voxels);
      block.threads([&](int thread) {
        const ValueRange& within = range->within;
        const BrickScale scale = within.empty() ? this->scaleOf(range->low, range->high)
                                                : this->scaleOf(within.low, within.high);
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
    ValueRange within = a.within;
    within.extend(b.within);
    return {b.low < a.low ? b.low : a.low, b.high > a.high ? b.high : a.high, a.marked + b.marked,
            within};
  }

  /// Of voxels and cells; of NaNs, if they are all that there is. Phases.
  template <class Block>
  INR_HOST_DEVICE const Range* findRange(Block& block, std::int64_t k, const float* values,
                                         std::int64_t count) const
  {
    Range* const ranges = reinterpret_cast<Range*>(block.shared());
    block.threads([&](int thread) {
      Range range{values[0], values[0], 0, {}};
      for (std::int64_t voxel = thread; voxel < count; voxel += Threads) {
        const float value = values[voxel];
        range = Joined(range, {value, value, value != value ? 1u : 0u, {}});
      }
      range.within = this->cellsOf(k, thread);
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

  /// The ranges of a thread's part of the cells that a brick lies in.
  INR_HOST_DEVICE ValueRange cellsOf(std::int64_t k, int thread) const
  {
    ValueRange range;
    if (this->cells.empty()) {
      return range;
    }
    const BrickId id = IdOf(WantedBricks::KeyOf(this->bricks[k]));
    const GridBox box = CellsOfBrick(this->cells, this->cache.hierarchy, id);
    for (std::int64_t at = thread; at < box.count(); at += Threads) {
      range.extend(this->cells.at(box.at(at)));
    }
    return range;
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

} // namespace cuda
} // namespace inr
