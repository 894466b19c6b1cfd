// SPDX-License-Identifier: BSD-3-Clause
//
// Several stores in one budget: who has how much of it, and when they may work.
#include "Core/Cache/KeptBricks.h"
#include "Core/Error.h"
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Testing/Core/Cache/KeyedBricks.h"
#include "Testing/Core/Cache/WholeBricks.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace test::cache_budget {

class CacheBudgetTest : public testing::Test
{
protected:
  static std::vector<inr::BrickKey> bricks(std::int64_t first, std::int64_t count)
  {
    std::vector<inr::BrickKey> keys;
    for (std::int64_t k = 0; k < count; ++k) {
      keys.push_back(KeyAt(first + k));
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
  const StorePointer large = MakeKeyedStore(this->Budget, 8, 50000);
  const StorePointer small = MakeKeyedStore(this->Budget, 4, 6000);
  const inr::BrickStore::Call call(*large, this->Threads);
  large->beginFrame();
  const std::int64_t loaded = large->load(Whole(this->bricks(0, 500)), this->Threads, {}).bricks;
  EXPECT_EQ(this->fill(*small), LeastBricks - 1); // beside the pinned one
  EXPECT_EQ(small->capacity(), LeastBricks);
  for (std::int64_t k = 0; k < loaded; ++k) {
    EXPECT_TRUE(HasBrick(*large, KeyAt(k)));
  }
  EXPECT_LE(this->Budget->bytes(), 50000);
}

TEST_F(CacheBudgetTest, MemoryGoesToWhatIsLookedAtAndBack)
{
  const StorePointer a = MakeKeyedStore(this->Budget, 8, 50000);
  const std::int64_t alone = this->fill(*a);
  const StorePointer b = MakeKeyedStore(this->Budget, 8, 50000);
  EXPECT_GT(this->fill(*b), alone - 2 * LeastBricks);
  EXPECT_EQ(a->mapped(), LeastBricks);
  EXPECT_GT(this->fill(*a), alone - 2 * LeastBricks);
  EXPECT_EQ(b->mapped(), LeastBricks);
  EXPECT_TRUE(HasBrick(*b, b->cache().hierarchy().coarsest()));
}

TEST_F(CacheBudgetTest, TheLimitFallsWithTheLargestStore)
{
  StorePointer large = MakeKeyedStore(this->Budget, 8, 80000);
  const StorePointer small = MakeKeyedStore(this->Budget, 8, 20000);
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
  const StorePointer a = MakeKeyedStore(this->Budget, 8, 60000, true);
  const std::int64_t least = a->cache().bytesFor(LeastBricks);
  {
    const inr::BrickStore::Call call(*a, this->Threads);
    const std::uint64_t frame = a->beginFrame();
    const std::int64_t before = this->Budget->bytes();
    a->loadFor(0, Whole(this->bricks(0, 40)), this->Threads);
    EXPECT_GE(this->Budget->bytes(), before + 40 * 128); // room for so many floats
    EXPECT_FALSE(a->hasLostSince(frame));
  }
  const StorePointer b = MakeKeyedStore(this->Budget, 8, 60000);
  this->fill(*b);
  EXPECT_LE(this->Budget->bytes(), 60000);
  const std::int64_t rest = this->Budget->bytes() - b->cache().bytes();
  EXPECT_LE(rest, least + 2 * 128); // a brick may have been in work
  EXPECT_TRUE(a->hasLostSince(a->frame()));
  const inr::BrickStore::Call call(*a, this->Threads);
  a->beginFrame();
  a->loadFor(1e9, Whole(this->bricks(0, 20)), this->Threads); // as if nothing had been
  EXPECT_TRUE(HasBrick(*a, KeyAt(0)));
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
      return std::shared_ptr<inr::BrickStore>(MakeKeyedStore(this->Budget, brickSize, bytes));
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
    return this->Budget->storeFor(key, [&] {
      return std::shared_ptr<inr::BrickStore>(MakeKeyedStore(this->Budget, 8, 50000));
    });
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
  const std::int64_t least = MakeKeyedStore(this->Budget, 8, 50000)->cache().bytesFor(LeastBricks);
  const auto field = std::make_shared<int>(0);
  const auto storeFor = [&](int brickSize) {
    const inr::StoreKey key{field,        {},        "kernel",
                            {4000, 2, 2}, brickSize, inr::CachePrecision::Float32,
                            6 * least,    false};
    return this->Budget->storeFor(key, [&] {
      return std::shared_ptr<inr::BrickStore>(MakeKeyedStore(this->Budget, brickSize, 6 * least));
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
  const auto slow = std::make_shared<KeyedBricks>(8, milliseconds(1));
  inr::BrickStore a(this->Budget, slow, inr::CachePrecision::Float32, 60000, true, 1);
  const StorePointer b = MakeKeyedStore(this->Budget, 8, 60000);
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
    a.loadFor(1e9, Whole({KeyAt(50), KeyAt(51)}), this->Threads); // for which somebody waits
    EXPECT_TRUE(HasBrick(a, KeyAt(51)));
    a.loadFor(0, Whole(this->bricks(0, 40)), this->Threads);
  }
  for (int tries = 0; tries < 6000 && slow->bricks() < 40; ++tries) {
    std::this_thread::sleep_for(milliseconds(5));
  }
  EXPECT_GE(slow->bricks(), 40);
}

TEST_F(CacheBudgetTest, RenderingFromAStoreInTheMiddleOfRenderingFromItIsRefused)
{
  const StorePointer a = MakeKeyedStore(this->Budget, 8, 50000);
  const StorePointer b = MakeKeyedStore(this->Budget, 8, 50000);
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
  const std::shared_ptr<inr::BrickStore> shared(MakeKeyedStore(budget, 8, 60000, true));
  const auto work = [&](std::uint64_t seed) {
    const inr::Arena threads(1);
    StorePointer own;
    for (std::uint64_t k = 0; k < 150; ++k) {
      const auto random = [&](std::uint64_t at, std::uint64_t below) {
        return static_cast<std::int64_t>(inr::RandomBits(seed, 8 * k + at) % below);
      };
      if (k % 20 == 0) {
        own = MakeKeyedStore(budget, 4 + static_cast<int>(seed), 30000 + random(0, 40000), true);
      }
      inr::BrickStore& store = random(1, 2) == 0 ? *shared : *own;
      const inr::BrickStore::Call call(store, threads);
      const std::uint64_t frame = store.beginFrame();
      std::vector<inr::BrickKey> missing;
      for (std::int64_t brick = random(2, 200), n = brick + random(3, 40); brick < n; ++brick) {
        const std::int32_t slot = store.cache().find(KeyAt(brick));
        if (slot >= 0) {
          store.cache().touch(slot);
          ASSERT_TRUE(HasBrick(store, KeyAt(brick)));
        } else {
          missing.push_back(KeyAt(brick));
        }
      }
      const bool some = store.cache().usedInFrame() + static_cast<std::int64_t>(missing.size()) > 0;
      if (random(4, 2) == 0) {
        store.loadFor(1e-4, Whole(missing), threads);
      } else {
        store.load(Whole(missing), threads, {});
      }
      ASSERT_TRUE(some && !store.hasLostSince(frame));
      ASSERT_GE(store.capacity(), LeastBricks);
    }
  };
  std::thread first(work, 1);
  std::thread second(work, 2);
  work(3);
  first.join();
  second.join();
  EXPECT_LE(budget->bytes(), budget->total());
}

} // namespace test::cache_budget
