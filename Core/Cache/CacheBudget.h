// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CachePrecision.h"

#include <glm/gtc/type_precision.hpp>

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace inr {

class BrickStore;
class KeptBricks;
struct MacroCells;

/// What a store's bricks depend on, and how much memory it may take: stores of the same are one.
struct StoreKey
{
  std::weak_ptr<const void> field;       ///< a model, or whatever else has the values
  std::weak_ptr<const MacroCells> cells; ///< over whose ranges these are rounded; none for the unit
  std::string kernel;                    ///< that infers them
  glm::i64vec3 dims;
  int brickSize;
  CachePrecision precision;
  std::int64_t bytes;
  bool background;
  std::weak_ptr<const void> accelerator = {}; ///< that infers them; none for the CPU

  bool operator==(const StoreKey& other) const;
};

/// The memory that stores share. All of them together stay within the most that one of them may
/// take or, should that be more, within the least that all of them need, FewestBricks each.
///
/// A store that needs memory gets what nobody has, then that of the least recently used bricks of
/// all stores, by a common clock; so the memory of what is no longer looked at goes to what is.
/// Every store keeps the least that it needs and can do its work whatever the others do. One that
/// somebody renders from gives nothing to others until that call ends. If that keeps more in use
/// than a limit allows that has just become lower, or should now hold one more store, then calls on
/// other threads wait.
class CacheBudget : public std::enable_shared_from_this<CacheBudget>
{
public:
  /// That of this process, which lasts as long as somebody holds it.
  static std::shared_ptr<CacheBudget> ofProcess();
  CacheBudget() = default;
  ~CacheBudget();
  CacheBudget(const CacheBudget&) = delete;
  CacheBudget& operator=(const CacheBudget&) = delete;

  /// The store with this key or, where nobody has one, what `make` makes, in this budget. Throws
  /// what `make` throws.
  std::shared_ptr<BrickStore> storeFor(const StoreKey& key,
                                       const std::function<std::shared_ptr<BrickStore>()>& make);

  std::int64_t total() const;
  std::int64_t bytes() const; ///< that all stores take at present: tables, queues and bricks

private:
  friend class BrickStore;
  friend class KeptBricks;

  // For who is making.
  void dropKept();
  /// Whether nobody but who keeps its bricks has a store.
  bool isIdle(const std::shared_ptr<BrickStore>& store) const;
  /// That idle stores need at least, together.
  std::int64_t leastOfIdle() const;

  // All that follows is for who holds the mutex.
  std::int64_t largest() const; ///< limit of a store
  std::int64_t limit() const;
  /// What a store can have when all others give what they can.
  std::int64_t roomFor(const BrickStore& asking) const;
  bool fits(std::int64_t bytes) const;
  /// Whose memory goes next, null when there is none; `asking` may be null.
  BrickStore* oldest(const BrickStore* asking) const;
  /// Takes memory until the limit is kept again.
  void settle();
  /// Pauses the loaders of all stores while there are calls, whichever store these are of.
  void beginCall();
  void endCall();

  mutable std::mutex Mutex;
  std::condition_variable TurnEnded;
  std::uint64_t Clock = 1; ///< frames begun by all stores
  std::vector<BrickStore*> Stores;
  int Calls = 0; ///< in progress

  std::mutex Making; ///< guards the next two; taken before the other
  std::vector<std::pair<StoreKey, std::weak_ptr<BrickStore>>> Shared;
  std::vector<KeptBricks*> Kept; ///< the earliest first
};

} // namespace inr
