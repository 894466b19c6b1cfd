// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/Kernels/CacheRanking.h"
#include "CUDA/Inference/Kernels/BrickGeometry.h"
#include "Core/GridBox.h"

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

/// Lists what is to be inferred: wanted bricks, as long as there are slots for them. By the first
/// block.
struct ListBricks
{
  static constexpr int Threads = 256;
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
    return GridCount(glm::i64vec3(dims));
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
      if (entries[middle].isNone()) {
        high = middle;
      } else {
        low = middle + 1;
      }
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

} // namespace cuda
} // namespace inr
