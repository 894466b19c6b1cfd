// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/CacheBudget.h"

#include "Core/Cache/BrickStore.h"
#include "Core/Cache/KeptBricks.h"
#include "Core/Model/MacroCells.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <type_traits>

namespace inr {

namespace {

// The process may end, or this library go, with or without somebody holding the budget.
static_assert(std::is_trivially_destructible_v<std::mutex>);
std::mutex OfProcessMutex;
CacheBudget* OfProcess = nullptr;

bool IsSame(const std::weak_ptr<const void>& a, const std::weak_ptr<const void>& b)
{
  return !a.owner_before(b) && !b.owner_before(a); // also true of no two that were never the same
}

/// Of two that somebody has, or none.
bool AreAlike(const std::weak_ptr<const MacroCells>& a, const std::weak_ptr<const MacroCells>& b)
{
  const std::shared_ptr<const MacroCells> one = a.lock();
  const std::shared_ptr<const MacroCells> other = b.lock();
  return one == other || (one && other && *one == *other);
}

} // namespace

bool StoreKey::operator==(const StoreKey& other) const
{
  const auto rest = [](const StoreKey& key) {
    return std::tie(key.kernel, key.dims.x, key.dims.y, key.dims.z, key.brickSize, key.precision,
                    key.bytes, key.background);
  };
  return IsSame(this->field, other.field) && IsSame(this->accelerator, other.accelerator) &&
         rest(*this) == rest(other) && AreAlike(this->cells, other.cells);
}

std::shared_ptr<CacheBudget> CacheBudget::ofProcess()
{
  const std::lock_guard<std::mutex> lock(OfProcessMutex);
  std::shared_ptr<CacheBudget> budget =
      OfProcess != nullptr ? OfProcess->weak_from_this().lock() : nullptr;
  if (!budget) { // none, or one that is waiting to say that it goes
    budget = std::make_shared<CacheBudget>();
    OfProcess = budget.get();
  }
  return budget;
}

CacheBudget::~CacheBudget()
{
  const std::lock_guard<std::mutex> lock(OfProcessMutex);
  if (OfProcess == this) {
    OfProcess = nullptr;
  }
}

std::shared_ptr<BrickStore>
CacheBudget::storeFor(const StoreKey& key, const std::function<std::shared_ptr<BrickStore>()>& make)
{
  const std::lock_guard<std::mutex> lock(this->Making);
  const auto isGone = [](const auto& entry) { return entry.second.expired(); };
  this->Shared.erase(std::remove_if(this->Shared.begin(), this->Shared.end(), isGone),
                     this->Shared.end());
  for (const auto& entry : this->Shared) {
    std::shared_ptr<BrickStore> store = entry.first == key ? entry.second.lock() : nullptr;
    if (store) {
      return store;
    }
  }
  std::shared_ptr<BrickStore> store = make();
  this->Shared.emplace_back(key, store);
  this->dropKept();
  return store;
}

/// Kept bricks go for good, the earliest first, where those that nobody uses would take much of the
/// memory even if they gave all that they can.
void CacheBudget::dropKept()
{
  constexpr std::int64_t share = 4;
  const auto tooMuch = [&] {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->leastOfIdle() > this->largest() / share;
  };
  while (tooMuch()) {
    const auto earliest =
        std::find_if(this->Kept.begin(), this->Kept.end(),
                     [&](const KeptBricks* kept) { return this->isIdle(kept->Store); });
    const BrickStore* const store = (*earliest)->Store.get();
    for (KeptBricks* kept : this->Kept) { // several may keep the same
      if (kept->Store.get() == store) {
        kept->Store.reset();
      }
    }
  }
}

bool CacheBudget::isIdle(const std::shared_ptr<BrickStore>& store) const
{
  const auto keepers = std::count_if(this->Kept.begin(), this->Kept.end(),
                                     [&](const KeptBricks* kept) { return kept->Store == store; });
  return store && store.use_count() == keepers;
}

std::int64_t CacheBudget::leastOfIdle() const
{
  std::set<const BrickStore*> idle;
  std::int64_t least = 0;
  for (const KeptBricks* kept : this->Kept) {
    if (this->isIdle(kept->Store) && idle.insert(kept->Store.get()).second) {
      least += kept->Store->least();
    }
  }
  return least;
}

std::int64_t CacheBudget::total() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return this->limit();
}

std::int64_t CacheBudget::bytes() const
{
  const std::lock_guard<std::mutex> lock(this->Mutex);
  return std::accumulate(
      this->Stores.begin(), this->Stores.end(), std::int64_t{0},
      [](std::int64_t sum, const BrickStore* store) { return sum + store->bytes(); });
}

std::int64_t CacheBudget::largest() const
{
  std::int64_t largest = 0;
  for (const BrickStore* store : this->Stores) {
    largest = std::max(largest, store->Limit);
  }
  return largest;
}

std::int64_t CacheBudget::limit() const
{
  std::int64_t least = 0;
  for (const BrickStore* store : this->Stores) {
    least += store->least();
  }
  return std::max(this->largest(), least);
}

bool CacheBudget::fits(std::int64_t bytes) const
{
  for (const BrickStore* store : this->Stores) {
    bytes += store->kept();
  }
  return bytes <= this->limit();
}

std::int64_t CacheBudget::roomFor(const BrickStore& asking) const
{
  std::int64_t room = this->limit();
  for (const BrickStore* store : this->Stores) {
    if (store != &asking) {
      room -= store->cannotGive();
    }
  }
  return room;
}

BrickStore* CacheBudget::oldest(const BrickStore* asking) const
{
  BrickStore* oldest = nullptr;
  std::uint64_t oldestUse = BrickCache::Pinned;
  for (BrickStore* store : this->Stores) {
    const bool mayBeTaken = !store->isInUse() || store == asking;
    const std::uint64_t use = mayBeTaken ? store->oldestUse() : BrickCache::Pinned;
    if (use < oldestUse) {
      oldest = store;
      oldestUse = use;
    }
  }
  return oldest;
}

void CacheBudget::settle()
{
  while (!this->fits(0)) {
    BrickStore* const store = this->oldest(nullptr);
    if (store == nullptr) {
      return; // all the rest is in use; who uses it will settle
    }
    store->giveOldest();
  }
}

void CacheBudget::beginCall()
{
  if (this->Calls++ == 0) {
    for (BrickStore* store : this->Stores) {
      store->setPaused(true);
    }
  }
}

void CacheBudget::endCall()
{
  if (--this->Calls == 0) {
    for (BrickStore* store : this->Stores) {
      store->setPaused(false);
    }
  }
}

} // namespace inr
