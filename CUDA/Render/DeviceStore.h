// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/CacheLayout.h"
#include "CUDA/Cache/CacheShares.h"
#include "Core/Cache/CachePrecision.h"
#include "Core/Cache/Hierarchy.h"
#include "Core/Error.h"
#include "Core/Model/MacroCells.h"

#include <atomic>
#include <cstdint>
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
  std::int64_t MadeFor;                      ///< bytes: the cache

public:
  /// `where`: of the machine; the others: of the cache, which takes its share.
  template <class Where, class Inference>
  DeviceStore(std::unique_ptr<CacheShares::Share> share, const Where& where, Inference inference,
              const Hierarchy& levels, CachePrecision precision, const MacroCells& cells)
      : Share(std::move(share)), MadeFor(this->Share->bytes()), machine(where), beside(where),
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
      store.Share->all().adjust(store.Adjusted);
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

  void adjustIfIdle() override
  {
    if (this->isMine()) {
      return;
    }
    std::unique_lock<std::mutex> lock(this->Mutex, std::try_to_lock);
    if (lock) {
      const Turn turn(*this, std::move(lock));
      this->adjust();
    }
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
    const bool isLost = this->cache.capacity() == 0;
    if (isLost || bytes < this->cache.bytes()) {
      this->resize(bytes);
    } else if (this->hasUseFor(bytes)) {
      try {
        this->cache.requireFree(bytes);
      } catch (const Error&) { // somebody else has the memory: what it has will do
        this->MadeFor = bytes;
        return;
      }
      this->resize(bytes);
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
    this->cache.resize(bytes);
    this->MadeFor = bytes;
    this->Share->take(this->cache.bytes());
  }

  std::mutex Mutex;
  std::atomic<std::thread::id> User{};
  std::uint64_t Adjusted = 0; ///< the division of memory to which all were adjusted
};

/// A store whose cache takes at most `limit` and shares memory with others. These make room at the
/// first turn of any: whom the new one replaces has gone by then. For the rest, and what is thrown,
/// see the cache.
template <class Machine, class Cache, class Where, class Inference>
std::shared_ptr<DeviceStore<Machine, Cache>>
MakeSharingStore(const std::shared_ptr<CacheShares>& shares, const Where& where,
                 Inference inference, const Hierarchy& levels, CachePrecision precision,
                 std::int64_t limit, const MacroCells& cells)
{
  const CacheNeeds needs = Cache::needs(inference, precision, cells);
  const CacheWish wish{LeastCacheBytes(levels, precision, needs),
                       LayOutCache(levels, precision, limit, needs).bytes, limit};
  auto store = std::make_shared<DeviceStore<Machine, Cache>>(
      std::make_unique<CacheShares::Share>(shares, wish), where, std::move(inference), levels,
      precision, cells);
  shares->add(store);
  return store;
}

} // namespace cuda
} // namespace inr
