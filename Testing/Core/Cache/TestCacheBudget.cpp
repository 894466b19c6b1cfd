// SPDX-License-Identifier: BSD-3-Clause
//
// Several stores in one budget, against a model that is nothing but bricks and when they were used.
#include "Core/Cache/BrickStore.h"
#include "Core/Cache/KeptBricks.h"
#include "Core/Error.h"
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Testing/Core/Cache/WholeBricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <thread>

namespace {

/// Bricks that tell their key, and how many layers of them were inferred.
class Source : public inr::BrickSource
{
public:
  explicit Source(int brickSize, std::chrono::milliseconds forALayer = {})
      : BrickSource(inr::Hierarchy({4000, 2, 2}, brickSize)), ForALayer(forALayer)
  {}

  void inferLayer(inr::BrickKey key, std::int64_t, float* values) const override
  {
    std::this_thread::sleep_for(this->ForALayer);
    const std::int64_t voxels = this->hierarchy().voxelsPerBrick() / 2;
    std::fill_n(values, voxels, ValueOf(key));
    ++this->Layers;
  }
  static float ValueOf(inr::BrickKey key) { return static_cast<float>(key % 4096) / 4096; }
  std::int64_t bricks() const { return this->Layers / 2; }

private:
  const std::chrono::milliseconds ForALayer;
  mutable std::atomic<std::int64_t> Layers{0};
};

inr::BrickKey Key(std::int64_t k) { return inr::KeyOf({0, {k, 0, 0}}); }

using StorePointer = std::unique_ptr<inr::BrickStore>;

StorePointer MakeStore(const std::shared_ptr<inr::CacheBudget>& budget, int brickSize,
                       std::int64_t bytes, bool background = false)
{
  return std::make_unique<inr::BrickStore>(budget, std::make_shared<Source>(brickSize),
                                           inr::CachePrecision::Float32, bytes, background, 1);
}

bool Has(const inr::BrickStore& store, inr::BrickKey key)
{
  const std::int32_t slot = store.cache().find(key);
  return slot >= 0 &&
         static_cast<const float*>(store.cache().view(slot).voxels)[0] == Source::ValueOf(key);
}

constexpr std::int64_t Least = inr::BrickCache::FewestBricks;

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
      return this->store->cache().bytesFor(std::max(Least, this->count + more));
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
      least += store.store ? store.store->cache().bytesFor(Least) : 0;
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
      if (store.count > Least && store.oldest() < end &&
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
    while (!replaces && to.count >= Least && !this->fits(to.kept(1) - to.kept())) {
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
    this->Stores[at] = MakeStore(this->Budget, brickSize, bytes);
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
      const inr::BrickKey key = Key(static_cast<std::int64_t>(first + this->random(40 + wanted)));
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
        const bool isThere = Has(*this->Stores[at], use->first);
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

class CacheBudgetTest : public testing::Test
{
protected:
  static std::vector<inr::BrickKey> bricks(std::int64_t first, std::int64_t count)
  {
    std::vector<inr::BrickKey> keys;
    for (std::int64_t k = 0; k < count; ++k) {
      keys.push_back(Key(first + k));
    }
    return keys;
  }
  std::int64_t fill(inr::BrickStore& store)
  {
    const inr::BrickStore::Call call(store, this->Threads);
    store.beginFrame();
    return store.load(Whole(this->bricks(0, 500)), this->Threads, {}).bricks;
  }

  std::shared_ptr<inr::CacheBudget> Budget = std::make_shared<inr::CacheBudget>();
  inr::Arena Threads{1};
};

TEST_F(CacheBudgetTest, AStoreInUseKeepsAllThatItHasAndTheOtherStillHasTheLeast)
{
  const StorePointer large = MakeStore(this->Budget, 8, 50000);
  const StorePointer small = MakeStore(this->Budget, 4, 6000);
  const inr::BrickStore::Call call(*large, this->Threads);
  large->beginFrame();
  const std::int64_t loaded = large->load(Whole(this->bricks(0, 500)), this->Threads, {}).bricks;
  EXPECT_EQ(this->fill(*small), Least - 1); // beside the pinned one
  EXPECT_EQ(small->capacity(), Least);
  for (std::int64_t k = 0; k < loaded; ++k) {
    EXPECT_TRUE(Has(*large, Key(k)));
  }
  EXPECT_LE(this->Budget->bytes(), 50000);
}

TEST_F(CacheBudgetTest, MemoryGoesToWhatIsLookedAtAndBack)
{
  const StorePointer a = MakeStore(this->Budget, 8, 50000);
  const std::int64_t alone = this->fill(*a);
  const StorePointer b = MakeStore(this->Budget, 8, 50000);
  EXPECT_GT(this->fill(*b), alone - 2 * Least);
  EXPECT_EQ(a->mapped(), Least);
  EXPECT_GT(this->fill(*a), alone - 2 * Least);
  EXPECT_EQ(b->mapped(), Least);
  EXPECT_TRUE(Has(*b, b->cache().hierarchy().coarsest()));
}

TEST_F(CacheBudgetTest, TheLimitFallsWithTheLargestStore)
{
  StorePointer large = MakeStore(this->Budget, 8, 80000);
  const StorePointer small = MakeStore(this->Budget, 8, 20000);
  this->fill(*small);
  this->fill(*large);
  EXPECT_LE(this->Budget->bytes(), 80000);
  EXPECT_GT(this->Budget->bytes(), 78000);
  large.reset();
  EXPECT_LE(this->Budget->bytes(), 20000);
  EXPECT_EQ(this->Budget->total(), 20000);
}

TEST_F(CacheBudgetTest, WhatALoaderHoldsCountsAndIsGivenBack)
{
  const StorePointer a = MakeStore(this->Budget, 8, 60000, true);
  const std::int64_t least = a->cache().bytesFor(Least);
  {
    const inr::BrickStore::Call call(*a, this->Threads);
    const std::uint64_t frame = a->beginFrame();
    const std::int64_t before = this->Budget->bytes();
    a->loadFor(0, Whole(this->bricks(0, 40)), this->Threads);
    EXPECT_GE(this->Budget->bytes(), before + 40 * 128); // room for so many floats
    EXPECT_FALSE(a->hasLostSince(frame));
  }
  const StorePointer b = MakeStore(this->Budget, 8, 60000);
  this->fill(*b);
  EXPECT_LE(this->Budget->bytes(), 60000);
  const std::int64_t rest = this->Budget->bytes() - b->cache().bytes();
  EXPECT_LE(rest, least + 2 * 128); // a brick may have been in work
  EXPECT_TRUE(a->hasLostSince(a->frame()));
  const inr::BrickStore::Call call(*a, this->Threads);
  a->beginFrame();
  a->loadFor(1e9, Whole(this->bricks(0, 20)), this->Threads); // as if nothing had been
  EXPECT_TRUE(Has(*a, Key(0)));
  EXPECT_LE(this->Budget->bytes(), 60000);
}

TEST_F(CacheBudgetTest, StoresOfTheSameAreOne)
{
  const auto field = std::make_shared<int>(0);
  const auto other = std::make_shared<int>(0);
  const auto storeFor = [&](const std::shared_ptr<int>& of, int brickSize, std::int64_t bytes) {
    const inr::StoreKey key{
        of, {}, "kernel", {4000, 2, 2}, brickSize, inr::CachePrecision::Float32, bytes, false};
    return this->Budget->storeFor(key, [&] {
      return std::shared_ptr<inr::BrickStore>(MakeStore(this->Budget, brickSize, bytes));
    });
  };
  const auto store = storeFor(field, 8, 50000);
  EXPECT_EQ(storeFor(field, 8, 50000), store);
  EXPECT_NE(storeFor(other, 8, 50000), store);
  EXPECT_NE(storeFor(field, 9, 50000), store);
  EXPECT_NE(storeFor(field, 8, 60000), store);
  EXPECT_THROW(storeFor(field, 8, 100), inr::Error);
  EXPECT_EQ(storeFor(field, 8, 50000), store);
}

TEST_F(CacheBudgetTest, StoresWhoseVoxelsAreRoundedOverOtherRangesAreNotOne)
{
  const auto field = std::make_shared<int>(0);
  const auto cellsUpTo = [](float high) {
    auto cells = std::make_shared<inr::MacroCells>(inr::MakeMacroCells({4000, 2, 2}, 16));
    std::fill(cells->ranges.begin(), cells->ranges.end(), inr::ValueRange{0.0f, high});
    return cells;
  };
  const auto storeFor = [&](const std::shared_ptr<inr::MacroCells>& cells) {
    const inr::StoreKey key{field, cells, "kernel", {4000, 2, 2}, 8, inr::CachePrecision::Float32,
                            50000, false};
    return this->Budget->storeFor(
        key, [&] { return std::shared_ptr<inr::BrickStore>(MakeStore(this->Budget, 8, 50000)); });
  };
  const auto half = cellsUpTo(0.5f);
  const auto store = storeFor(half);
  EXPECT_EQ(storeFor(half), store);
  EXPECT_EQ(storeFor(cellsUpTo(0.5f)), store);
  EXPECT_NE(storeFor(cellsUpTo(0.6f)), store);
  EXPECT_NE(storeFor(nullptr), store);
}

/// Of what idle stores need at least, a quarter of the budget has room for one, however many keep
/// it.
TEST_F(CacheBudgetTest, KeptStoresCountOnceAndGoAsAWhole)
{
  const std::int64_t least = MakeStore(this->Budget, 8, 50000)->cache().bytesFor(Least);
  const auto field = std::make_shared<int>(0);
  const auto storeFor = [&](int brickSize) {
    const inr::StoreKey key{field,        {},        "kernel",
                            {4000, 2, 2}, brickSize, inr::CachePrecision::Float32,
                            6 * least,    false};
    return this->Budget->storeFor(key, [&] {
      return std::shared_ptr<inr::BrickStore>(MakeStore(this->Budget, brickSize, 6 * least));
    });
  };
  const inr::KeptBricks kept(storeFor(8));
  const inr::KeptBricks keptToo(storeFor(8));
  const std::weak_ptr<inr::BrickStore> first = storeFor(8);
  const inr::KeptBricks last(storeFor(7));
  EXPECT_FALSE(first.expired());
  storeFor(6);
  EXPECT_TRUE(first.expired());
  EXPECT_EQ(this->Budget->bytes(), storeFor(7)->cache().bytes());
}

/// A frame has the machine to itself, whosever bricks are still to come.
TEST_F(CacheBudgetTest, LoadersRestWhileThereIsACallOfAnyStore)
{
  using std::chrono::milliseconds;
  const auto slow = std::make_shared<Source>(8, milliseconds(1));
  inr::BrickStore a(this->Budget, slow, inr::CachePrecision::Float32, 60000, true, 1);
  const StorePointer b = MakeStore(this->Budget, 8, 60000);
  {
    const inr::BrickStore::Call call(a, this->Threads);
    a.beginFrame();
    a.loadFor(0, Whole(this->bricks(0, 40)), this->Threads);
  }
  /// Waits until nothing has come for a while, or all has.
  const auto settle = [&] {
    std::int64_t before = -1;
    for (int quiet = 0; quiet < 5 && slow->bricks() < 40;) {
      std::this_thread::sleep_for(milliseconds(20));
      quiet = slow->bricks() == before ? quiet + 1 : 0;
      before = slow->bricks();
    }
    return before;
  };
  {
    const inr::BrickStore::Call call(*b, this->Threads);
    EXPECT_LT(settle(), 40); // what is begun comes to its end, and no more
    const inr::BrickStore::Call another(a, this->Threads);
    a.beginFrame();
    a.loadFor(1e9, Whole({Key(50), Key(51)}), this->Threads); // for which somebody waits
    EXPECT_TRUE(Has(a, Key(51)));
    a.loadFor(0, Whole(this->bricks(0, 40)), this->Threads);
  }
  for (int tries = 0; tries < 6000 && slow->bricks() < 40; ++tries) {
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_GE(slow->bricks(), 40);
}

TEST_F(CacheBudgetTest, RenderingFromAStoreInTheMiddleOfRenderingFromItIsRefused)
{
  const StorePointer a = MakeStore(this->Budget, 8, 50000);
  const StorePointer b = MakeStore(this->Budget, 8, 50000);
  const inr::BrickStore::Call call(*a, this->Threads);
  const inr::BrickStore::Call within(*b, this->Threads);
  EXPECT_THROW(inr::BrickStore::Call(*a, this->Threads), inr::Error);
}

TEST(CacheBudgetOfProcess, LastsAsLongAsSomebodyHoldsIt)
{
  std::weak_ptr<inr::CacheBudget> first;
  {
    const std::shared_ptr<inr::CacheBudget> budget = inr::CacheBudget::ofProcess();
    EXPECT_EQ(inr::CacheBudget::ofProcess(), budget);
    first = budget;
  }
  EXPECT_TRUE(first.expired());
  EXPECT_NE(inr::CacheBudget::ofProcess(), nullptr);
}

// What ThreadSanitizer is to watch.
TEST(CacheBudgetThreads, StoresComeAndGoAndLoadWhileOthersDo)
{
  const auto budget = std::make_shared<inr::CacheBudget>();
  const std::shared_ptr<inr::BrickStore> shared(MakeStore(budget, 8, 60000, true));
  const auto work = [&](std::uint64_t seed) {
    const inr::Arena threads(1);
    StorePointer own;
    for (std::uint64_t k = 0; k < 150; ++k) {
      const auto random = [&](std::uint64_t at, std::uint64_t below) {
        return static_cast<std::int64_t>(inr::RandomBits(seed, 8 * k + at) % below);
      };
      if (k % 20 == 0) {
        own = MakeStore(budget, 4 + static_cast<int>(seed), 30000 + random(0, 40000), true);
      }
      inr::BrickStore& store = random(1, 2) == 0 ? *shared : *own;
      const inr::BrickStore::Call call(store, threads);
      const std::uint64_t frame = store.beginFrame();
      std::vector<inr::BrickKey> missing;
      for (std::int64_t brick = random(2, 200), n = brick + random(3, 40); brick < n; ++brick) {
        const std::int32_t slot = store.cache().find(Key(brick));
        if (slot >= 0) {
          store.cache().touch(slot);
          ASSERT_TRUE(Has(store, Key(brick)));
        } else {
          missing.push_back(Key(brick));
        }
      }
      const bool some = store.cache().usedInFrame() + static_cast<std::int64_t>(missing.size()) > 0;
      if (random(4, 2) == 0) {
        store.loadFor(1e-4, Whole(missing), threads);
      } else {
        store.load(Whole(missing), threads, {});
      }
      ASSERT_TRUE(some && !store.hasLostSince(frame));
      ASSERT_GE(store.capacity(), Least);
    }
  };
  std::thread first(work, 1);
  std::thread second(work, 2);
  work(3);
  first.join();
  second.join();
  EXPECT_LE(budget->bytes(), budget->total());
}

} // namespace
