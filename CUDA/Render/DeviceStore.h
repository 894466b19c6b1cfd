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
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace inr {
namespace cuda {

/// A machine and the cache of bricks on it, which all renderers of the same field with the same
/// cache share. They take turns.
template <class Machine, class Cache> struct DeviceStore : CacheShares::Holder
{
  /// `where`: of the machine; `arguments`: of the cache behind it.
  template <class Where, class... Arguments>
  explicit DeviceStore(const Where& where, Arguments&&... arguments)
      : machine(where), beside(where), cache(this->machine, std::forward<Arguments>(arguments)...)
  {}

  /// The time of one call that draws: others wait.
  class Turn
  {
  public:
    /// Throws Error(Cancelled) where waiting would be for ever: in the middle of drawing on the
    /// same thread; and what adjusting the cache to its share does.
    explicit Turn(DeviceStore& store) : Turn(store, std::unique_lock<std::mutex>())
    {
      store.adjust();
    }
    ~Turn() { this->Store.User = std::thread::id(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

  private:
    friend DeviceStore;

    /// With the store's mutex, if it has that already.
    Turn(DeviceStore& store, std::unique_lock<std::mutex> lock)
        : Store(store), Lock(std::move(lock))
    {
      if (!this->Lock) {
        if (store.isMine()) {
          throw Error(ErrorCode::Cancelled, "rendering from a cache that is in use by this thread");
        }
        this->Lock = std::unique_lock<std::mutex>(store.Mutex);
      }
      store.User = std::this_thread::get_id();
    }

    DeviceStore& Store;
    std::unique_lock<std::mutex> Lock;
  };

  /// From here on the cache, which has been made for so many bytes, takes its share.
  void follow(std::unique_ptr<CacheShares::Share> share, std::int64_t madeFor)
  {
    this->Share = std::move(share);
    this->MadeFor = madeFor;
    this->Share->take(this->cache.bytes());
  }
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
  std::int64_t bytes() const
  {
    return this->Share ? this->Share->all().taken() : this->cache.bytes();
  }

private:
  std::unique_ptr<CacheShares::Share> Share; ///< goes when the cache has; none: that stays as it is

public:
  Machine machine;
  Machine beside; ///< the same, for what goes on at the same time
  Cache cache;

private:
  bool isMine() const { return this->User == std::this_thread::get_id(); }

  /// To another size, which costs all bricks: to a smaller one at once, but to a larger one only
  /// where that is of use, or costs none.
  void adjust()
  {
    const std::int64_t bytes = this->Share ? this->Share->bytes() : this->MadeFor;
    const std::int64_t bricks = this->cache.mapped();
    const bool shrinks = bytes < this->cache.bytes();
    const bool grows = bytes / 5 * 4 >= this->MadeFor &&
                       (bricks == this->cache.capacity() || bricks <= 1 /* the coarsest */);
    if (bytes != this->MadeFor && (shrinks || grows)) {
      this->MadeFor = 0; // until it is: that may fail, and is tried again then
      this->Share->take(0);
      this->cache.resize(bytes);
      this->MadeFor = bytes;
      this->Share->take(this->cache.bytes());
    }
  }

  std::mutex Mutex;
  std::atomic<std::thread::id> User{};
  std::int64_t MadeFor = 0; ///< bytes
};

/// A store whose cache takes at most `limit` and shares memory with others, which are adjusted
/// first, as far as nobody uses them. `where`: of its machine; the rest, and what is thrown: see
/// the cache.
template <class Machine, class Cache, class Where, class Inference>
std::shared_ptr<DeviceStore<Machine, Cache>>
MakeSharingStore(const std::shared_ptr<CacheShares>& shares, const Where& where,
                 Inference inference, const Hierarchy& levels, CachePrecision precision,
                 std::int64_t limit, const MacroCells& cells)
{
  const CacheNeeds needs = Cache::needs(inference, precision, cells);
  const std::int64_t most = LayOutCache(levels, precision, limit, needs).bytes;
  const std::int64_t least = std::min(LeastCacheBytes(levels, precision, needs), most);
  auto share = std::make_unique<CacheShares::Share>(shares, CacheWish{least, most, limit});
  shares->adjust();
  const std::int64_t bytes = share->bytes();
  auto store = std::make_shared<DeviceStore<Machine, Cache>>(where, std::move(inference), levels,
                                                             precision, bytes, cells);
  store->follow(std::move(share), bytes);
  shares->add(store);
  return store;
}

} // namespace cuda
} // namespace inr
