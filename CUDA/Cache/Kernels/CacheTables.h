// SPDX-License-Identifier: BSD-3-Clause
//
// The tables of a cache between frames.
#pragma once

#include "CUDA/Cache/Kernels/CacheView.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Forgets all wishes.
struct ClearRequests
{
  static constexpr int Threads = 256;

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

/// Enters all slots that are in use into a page table of free entries.
struct MapSlots
{
  static constexpr int Threads = 256;

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
