// SPDX-License-Identifier: BSD-3-Clause
//
// What a renderer's kernels do with a cache of bricks.
#pragma once

#include "CUDA/Cache/Kernels/CacheView.h"

#include <vector>

struct Wish
{
  inr::BrickKey key;
  float contribution;
};

/// Uses bricks that are mapped and asks for the others.
struct AskFor
{
  static constexpr int Threads = 64;

  inr::cuda::CacheView cache;
  const Wish* wishes;
  std::int64_t count;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    block.threads([&](int thread) {
      const std::int64_t stride = std::int64_t{block.count()} * Threads;
      for (std::int64_t k = std::int64_t{block.index()} * Threads + thread; k < this->count;
           k += stride) {
        const Wish& wish = this->wishes[k];
        const std::int32_t slot = this->cache.find(wish.key);
        if (slot != inr::cuda::CacheView::Unmapped) {
          this->cache.touch(slot);
        } else {
          this->cache.request(wish.key, wish.contribution);
        }
      }
    });
  }
};

template <class Machine>
void Ask(Machine& machine, const inr::cuda::CacheView& cache, const std::vector<Wish>& wishes)
{
  const auto count = static_cast<std::int64_t>(wishes.size());
  const auto uploaded = machine.template allocate<Wish>(count);
  machine.toMachine(uploaded.data(), wishes.data(), count);
  machine.run(AskFor{cache, uploaded.data(), count}, count);
  machine.wait();
}
