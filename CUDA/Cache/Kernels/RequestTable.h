// SPDX-License-Identifier: BSD-3-Clause
//
// Wishes for bricks, added up by brick, whichever threads have them in whatever order.
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "Core/Cache/BrickKey.h"
#include "Core/Random.h"

#include <cstdint>

namespace inr {
namespace cuda {

constexpr BrickKey NoBrick = ~BrickKey{0}; ///< keys have 62 bits

struct alignas(16) RequestEntry
{
  BrickKey key;               ///< NoBrick where it is free
  std::uint64_t contribution; ///< see RequestTable::Amount
};

struct RequestCounts
{
  std::uint64_t bricks;     ///< that have an entry
  std::uint64_t overflowed; ///< wishes, or more, for which there was none; 0 when there were none
};

/// Open addressing, linear probing. Sums are integers, so that no order of threads changes them,
/// nor, but for what overflows, which bricks are there.
struct RequestTable
{
  static constexpr std::uint32_t MostProbes = 64; ///< so that a full table hangs nobody
  static constexpr int FractionBits = 28;
  static constexpr float MostPerWish = 4096.0f;
  /// Sums from here on are all the same: additions end there, well before they could wrap.
  static constexpr std::uint64_t Saturated = std::uint64_t{1} << 63;

  RequestEntry* entries;
  std::uint32_t mask; ///< their number, a power of two, less one
  RequestCounts* counts;

  /// A contribution as it is summed. Not a number is nothing.
  INR_HOST_DEVICE static std::uint64_t Amount(float contribution)
  {
    const float least = contribution > 0.0f ? contribution : 0.0f;
    const float kept = least < MostPerWish ? least : MostPerWish;
    return static_cast<std::uint64_t>(kept * static_cast<float>(1 << FractionBits));
  }

  /// Where threads of a warp call this at once, one of them adds for all that want the same brick:
  /// a brick that many rays miss would have them queue.
  INR_HOST_DEVICE void add(BrickKey key, float contribution) const
  {
    std::uint64_t amount = Amount(contribution);
    if (IsSpokesman(key, amount)) {
      this->addAmount(key, amount);
    }
  }

private:
  INR_HOST_DEVICE void addAmount(BrickKey key, std::uint64_t amount) const
  {
    auto place = static_cast<std::uint32_t>(MixBits(key)) & this->mask;
    for (std::uint32_t probe = 0; probe < MostProbes && probe <= this->mask; ++probe) {
      RequestEntry& entry = this->entries[place];
      BrickKey owner = entry.key; // mostly it is there, and reading is cheaper than exchanging
      if (owner == NoBrick) {
        owner = AtomicExchangeIf(entry.key, NoBrick, key);
        if (owner == NoBrick) {
          AtomicAdd(this->counts->bricks, std::uint64_t{1});
          owner = key;
        }
      }
      if (owner == key) {
        Increase(entry.contribution, amount);
        return;
      }
      place = (place + 1) & this->mask;
    }
    AtomicAdd(this->counts->overflowed, std::uint64_t{1});
  }

  INR_HOST_DEVICE static void Increase(std::uint64_t& sum, std::uint64_t amount)
  {
    if (*static_cast<volatile std::uint64_t*>(&sum) < Saturated) { // not as it was a while ago
      AtomicAdd(sum, amount);
    }
  }

  /// Whether the calling thread adds for all threads of its warp that are here with the same key;
  /// `amount` becomes their sum.
  INR_HOST_DEVICE static bool IsSpokesman(BrickKey key, std::uint64_t& amount)
  {
#ifdef __CUDA_ARCH__
    const unsigned peers = __match_any_sync(__activemask(), static_cast<unsigned long long>(key));
    const auto own = static_cast<unsigned long long>(amount);
    amount = 0;
    for (unsigned rest = peers; rest != 0; rest &= rest - 1) {
      amount += __shfl_sync(peers, own, __ffs(static_cast<int>(rest)) - 1);
    }
    const unsigned lane = threadIdx.x % 32;
    return static_cast<unsigned>(__ffs(static_cast<int>(peers))) == lane + 1;
#else
    static_cast<void>(key);
    static_cast<void>(amount);
    return true;
#endif
  }
};

} // namespace cuda
} // namespace inr
