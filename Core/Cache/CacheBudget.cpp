// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/CacheBudget.h"

#include "Core/Cache/BrickStore.h"
#include "Core/Cache/KeptBricks.h"

#include <algorithm>
#include <numeric>
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

} // namespace

bool StoreKey::operator==(const StoreKey& other) const
{
  const auto rest = [](const StoreKey& key) {
    return std::tie(key.kernel, key.dims.x, key.dims.y, key.dims.z, key.brickSize, key.precision,
                    key.bytes, key.background);
  };
  return IsSame(this->field, other.field) && IsSame(this->accelerator, other.accelerator) &&
         rest(*this) == rest(other);
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
  const auto idle = [](const KeptBricks* kept) { return kept->Store.use_count() == 1; };
  const auto tooMuch = [&] {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    std::int64_t least = 0;
    for (const KeptBricks* kept : this->Kept) {
      least += idle(kept) ? kept->Store->least() : 0;
    }
    return least > this->largest() / share;
  };
  while (tooMuch()) {
    (*std::find_if(this->Kept.begin(), this->Kept.end(), idle))->Store.reset();
  }
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

} // namespace inr
