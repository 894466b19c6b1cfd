// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Error.h"

#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

namespace inr {
namespace cuda {

/// A machine and the cache of bricks on it, which all renderers of the same field with the same
/// cache share. They take turns.
template <class Machine, class Cache> struct DeviceStore
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
    /// same thread.
    explicit Turn(DeviceStore& store) : Store(store)
    {
      if (store.User == std::this_thread::get_id()) {
        throw Error(ErrorCode::Cancelled, "rendering from a cache that is in use by this thread");
      }
      store.Mutex.lock();
      store.User = std::this_thread::get_id();
    }
    ~Turn()
    {
      this->Store.User = std::thread::id();
      this->Store.Mutex.unlock();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

  private:
    DeviceStore& Store;
  };

  Machine machine;
  Machine beside; ///< the same, for what goes on at the same time
  Cache cache;

private:
  std::mutex Mutex;
  std::atomic<std::thread::id> User{};
};

} // namespace cuda
} // namespace inr
