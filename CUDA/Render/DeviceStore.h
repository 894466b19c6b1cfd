// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/CacheLayout.h"
#include "CUDA/Cache/CacheShares.h"
#include "Core/Cache/CachePrecision.h"
#include "Core/Cache/Hierarchy.h"
#include "Core/Error.h"
#include "Core/Model/MacroCells.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace inr {
namespace cuda {

/// A machine and the cache of bricks on it, which all renderers of the same field with the same
/// cache share. They take turns.
template <class Machine, class Cache> class DeviceStore : public CacheShares::Holder
{
  std::unique_ptr<CacheShares::Share> Share; ///< first, as it is to go last
  std::int64_t MadeFor;                      ///< bytes: the cache; 0: it is of no use

public:
  /// `where`: of the machine; the others: of the cache, which takes so many bytes until its first
  /// turn, and its share from then on.
  template <class Where, class Inference>
  DeviceStore(std::unique_ptr<CacheShares::Share> share, std::int64_t bytes, const Where& where,
              Inference inference, const Hierarchy& levels, CachePrecision precision,
              const MacroCells& cells)
      : Share(std::move(share)), MadeFor(bytes), machine(where), beside(where),
        cache(this->machine, std::move(inference), levels, precision, this->MadeFor, cells)
  {
    this->Share->take(this->cache.bytes());
  }

  /// The time of one call that draws: others wait.
  class Turn
  {
  public:
    /// Throws Error(Cancelled) where waiting would be for ever: in the middle of drawing on the
    /// same thread; and Error(Device) where the cache cannot have its share.
    explicit Turn(DeviceStore& store) : Turn(store, store.lock())
    {
      store.Share->all().adjust(store, store.Adjusted);
      store.adjust();
    }
    ~Turn() { this->Store.User = std::thread::id(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

  private:
    friend DeviceStore;

    Turn(DeviceStore& store, std::unique_lock<std::mutex> lock)
        : Store(store), Lock(std::move(lock))
    {
      store.User = std::this_thread::get_id();
    }

    DeviceStore& Store;
    std::unique_lock<std::mutex> Lock;
  };

  bool adjustIfIdle() override
  {
    if (this->isMine()) {
      return false;
    }
    std::unique_lock<std::mutex> lock(this->Mutex, std::try_to_lock);
    if (!lock) {
      return false;
    }
    const Turn turn(*this, std::move(lock));
    this->adjust();
    return true;
  }

  /// Of the memory that this cache shares, by all caches.
  std::int64_t bytes() const { return this->Share->all().taken(); }

  Machine machine;
  Machine beside; ///< the same, for what goes on at the same time
  Cache cache;

private:
  bool isMine() const { return this->User == std::this_thread::get_id(); }

  std::unique_lock<std::mutex> lock()
  {
    if (this->isMine()) {
      throw Error(ErrorCode::Cancelled, "rendering from a cache that is in use by this thread");
    }
    return std::unique_lock<std::mutex>(this->Mutex);
  }

  /// To another size, which costs all bricks: to a smaller one at once.
  void adjust()
  {
    const std::int64_t bytes = this->Share->bytes();
    if (bytes == this->MadeFor) {
      return;
    }
    if (this->MadeFor == 0) { // it is lost
      this->cache.requireFree(bytes);
      this->resize(bytes);
    } else if (bytes < this->cache.bytes()) {
      this->resize(bytes);
    } else if (this->hasUseFor(bytes)) {
      this->grow(bytes);
    }
  }

  void grow(std::int64_t bytes)
  {
    if (this->Refusal > 0) {
      --this->Refusal;
      return;
    }
    const std::int64_t before = this->MadeFor;
    try {
      this->cache.requireFree(bytes);
      this->resize(bytes);
    } catch (const Error&) { // somebody else has the memory: what it has will do for a while
      this->Refusal = TurnsUntilAskedAgain;
      if (this->MadeFor == 0) { // and took it in between
        this->resize(before);
      }
    }
  }

  /// Whether a larger cache is worth its bricks, or costs none but the coarsest.
  bool hasUseFor(std::int64_t bytes) const
  {
    const std::int64_t bricks = this->cache.mapped();
    const std::int64_t now = this->cache.capacity();
    const std::int64_t then = this->cache.capacityWithin(bytes);
    return (bricks == now && then > now + now / 4) || (bricks <= 1 && then > now);
  }

  void resize(std::int64_t bytes)
  {
    this->MadeFor = 0; // until it is: that may fail, and is tried again then
    try {
      this->cache.resize(bytes);
    } catch (...) {
      this->Share->take(this->cache.bytes());
      throw;
    }
    this->MadeFor = bytes;
    this->Share->take(this->cache.bytes());
  }

  /// A GPU takes some time to say how much is free.
  static constexpr int TurnsUntilAskedAgain = 100;

  std::mutex Mutex;
  std::atomic<std::thread::id> User{};
  std::uint64_t Adjusted = 0; ///< the division of memory to which all were adjusted
  int Refusal = 0;            ///< turns for which a larger cache is not asked for
};

/// A store whose cache takes at most `limit` and shares memory with others. These make room at the
/// first turn of any, not before: whom the new one replaces has mostly gone by then, but where a
/// second view still shows it. Until its own first turn it takes no more than `free`, or what it
/// cannot do without. For the rest, and what is thrown, see the cache.
template <class Machine, class Cache, class Where, class Inference>
std::shared_ptr<DeviceStore<Machine, Cache>>
MakeSharingStore(const std::shared_ptr<CacheShares>& shares, const Where& where,
                 Inference inference, const Hierarchy& levels, CachePrecision precision,
                 std::int64_t limit, const MacroCells& cells,
                 std::int64_t free = std::numeric_limits<std::int64_t>::max())
{
  const CacheNeeds needs = Cache::needs(inference, precision, cells);
  const CacheWish wish{LeastCacheBytes(levels, precision, needs),
                       LayOutCache(levels, precision, limit, needs).bytes, limit};
  auto share = std::make_unique<CacheShares::Share>(shares, wish);
  const std::int64_t bytes = std::max(wish.least, std::min(share->bytes(), free));
  auto store = std::make_shared<DeviceStore<Machine, Cache>>(
      std::move(share), bytes, where, std::move(inference), levels, precision, cells);
  shares->add(store);
  return store;
}

} // namespace cuda
} // namespace inr
