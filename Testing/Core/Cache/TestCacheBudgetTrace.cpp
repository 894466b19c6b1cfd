// SPDX-License-Identifier: BSD-3-Clause
//
// Several stores in one budget, against a model that is nothing but bricks and when they were used.
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Testing/Core/Cache/KeyedBricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <memory>
#include <vector>

namespace test::cache_budget_trace {

/// What should be in the stores: how many bricks were last used when.
class Model
{
public:
  struct Store
  {
    const inr::BrickStore* store = nullptr;
    std::int64_t limit = 0;
    std::map<std::uint64_t, std::int64_t> uses; ///< bricks that were last used then
    std::int64_t count = 0;

    std::int64_t kept(std::int64_t more = 0) const
    {
      return this->store->cache().bytesFor(std::max(LeastBricks, this->count + more));
    }
    void add(std::uint64_t use, std::int64_t number)
    {
      this->count += number;
      if ((this->uses[use] += number) == 0) {
        this->uses.erase(use);
      }
    }
    std::uint64_t oldest() const { return this->uses.begin()->first; }
  };

  std::int64_t total() const
  {
    std::int64_t largest = 0;
    std::int64_t least = 0;
    for (const Store& store : this->Stores) {
      largest = std::max(largest, store.limit);
      least += store.store ? store.store->cache().bytesFor(LeastBricks) : 0;
    }
    return std::max(largest, least);
  }
  bool fits(std::int64_t more) const
  {
    for (const Store& store : this->Stores) {
      more += store.store ? store.kept() : 0;
    }
    return more <= this->total();
  }
  /// The store with the oldest brick that may go for one in `asking`, which is in `frame`.
  Store* oldest(const Store* asking, std::uint64_t frame)
  {
    Store* oldest = nullptr;
    for (Store& store : this->Stores) {
      const std::uint64_t end = &store == asking ? frame : inr::BrickCache::Pinned;
      if (store.count > LeastBricks && store.oldest() < end &&
          (oldest == nullptr || store.oldest() < oldest->oldest())) {
        oldest = &store;
      }
    }
    return oldest;
  }
  void settle()
  {
    while (!this->fits(0)) {
      Store* const store = this->oldest(nullptr, 0);
      ASSERT_NE(store, nullptr);
      store->add(store->oldest(), -1);
    }
  }
  bool insert(Store& to, std::uint64_t frame)
  {
    bool replaces = to.count == to.store->cache().capacity();
    while (!replaces && to.count >= LeastBricks && !this->fits(to.kept(1) - to.kept())) {
      Store* const from = this->oldest(&to, frame);
      replaces = from == nullptr || from == &to;
      if (!replaces) {
        from->add(from->oldest(), -1);
      }
    }
    if (replaces) {
      if (to.oldest() >= frame) {
        return false;
      }
      to.add(to.oldest(), -1);
    }
    to.add(frame, 1);
    return true;
  }

  std::vector<Store> Stores{3};
};

class CacheBudgetTrace : public testing::TestWithParam<std::uint64_t>
{
protected:
  std::uint64_t random(std::uint64_t below)
  {
    return inr::RandomBits(GetParam(), this->Counter++) % below;
  }

  void replaceStore(std::size_t at)
  {
    this->Stores[at].reset();
    this->Expected.Stores[at] = {};
    this->Uses[at].clear();
    this->Expected.settle();
    const std::int64_t bytes = 15000 + static_cast<std::int64_t>(this->random(60000));
    const int brickSize = 4 + static_cast<int>(3 * at);
    this->Stores[at] = MakeKeyedStore(this->Budget, brickSize, bytes);
    this->Expected.Stores[at].store = this->Stores[at].get();
    this->Expected.Stores[at].limit = bytes;
    this->Expected.settle();
  }

  /// A frame that uses some bricks of one store, those around a place that moves.
  void render(std::size_t at)
  {
    inr::BrickStore& store = *this->Stores[at];
    Model::Store& expected = this->Expected.Stores[at];
    std::map<inr::BrickKey, std::uint64_t>& uses = this->Uses[at];
    const inr::BrickStore::Call call(store, this->Threads);
    const inr::BrickKey coarsest = store.cache().hierarchy().coarsest();
    if (uses.emplace(coarsest, inr::BrickCache::Pinned).second) {
      expected.add(inr::BrickCache::Pinned, 1);
    }
    const std::uint64_t frame = store.beginFrame();
    const std::uint64_t first = this->random(300);
    const std::uint64_t wanted = 1 + this->random(this->random(4) == 0 ? 200 : 30);
    for (std::uint64_t k = 0; k < wanted; ++k) {
      const inr::BrickKey key = KeyAt(static_cast<std::int64_t>(first + this->random(40 + wanted)));
      const std::int32_t slot = store.cache().find(key);
      ASSERT_EQ(slot >= 0, uses.count(key) == 1);
      if (slot >= 0) {
        store.cache().touch(slot);
        expected.add(uses[key], -1);
        expected.add(frame, 1);
        uses[key] = frame;
        continue;
      }
      const bool full = store.load({key}, this->Threads, {}).full;
      ASSERT_EQ(full, !this->Expected.insert(expected, frame));
      if (!full) {
        uses[key] = frame;
      }
      this->forgetWhatIsGone();
    }
  }

  void forgetWhatIsGone()
  {
    for (std::size_t at = 0; at < this->Stores.size(); ++at) {
      std::map<std::uint64_t, std::int64_t> left;
      for (auto use = this->Uses[at].begin(); use != this->Uses[at].end();) {
        const bool isThere = HasBrick(*this->Stores[at], use->first);
        left[use->second] += isThere ? 1 : 0;
        if (left[use->second] == 0) {
          left.erase(use->second);
        }
        use = isThere ? std::next(use) : this->Uses[at].erase(use);
      }
      ASSERT_EQ(left, this->Expected.Stores[at].uses);
    }
    ASSERT_LE(this->Budget->bytes(), this->Expected.total());
    ASSERT_EQ(this->Budget->total(), this->Expected.total());
  }

  std::shared_ptr<inr::CacheBudget> Budget = std::make_shared<inr::CacheBudget>();
  inr::Arena Threads{1};
  std::vector<StorePointer> Stores{3};
  Model Expected;
  std::map<inr::BrickKey, std::uint64_t> Uses[3]; ///< of what is mapped
  std::uint64_t Counter = 0;
};
INSTANTIATE_TEST_SUITE_P(Seeds, CacheBudgetTrace, testing::Values(1, 2, 3, 4, 5),
                         testing::PrintToStringParamName());

TEST_P(CacheBudgetTrace, TheLeastRecentlyUsedBricksOfAllStoresGo)
{
  for (std::size_t at = 0; at < 3; ++at) {
    this->replaceStore(at);
  }
  for (int k = 0; k < 300 && !HasFatalFailure(); ++k) {
    this->render(this->random(3));
    if (this->random(25) == 0) {
      this->replaceStore(this->random(3));
      this->forgetWhatIsGone();
    }
  }
}

} // namespace test::cache_budget_trace
