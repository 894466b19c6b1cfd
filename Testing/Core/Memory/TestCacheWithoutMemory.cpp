// SPDX-License-Identifier: BSD-3-Clause
//
// Every allocation of a cache's work fails: bricks that were there are found as they were, or gone.
#include "Core/Cache/BrickCache.h"
#include "Core/Random.h"
#include "Testing/Core/Memory/FailingMemory.h"

#include <gtest/gtest.h>

#include <map>

namespace test::cache_without_memory {

using For = FailingMemory::For;

/// A cache, and what it ought to hold.
struct Bricks
{
  explicit Bricks(std::int64_t bytes) : Cache(Levels, inr::CachePrecision::Float32, bytes) {}

  inr::BrickKey keyOf(std::uint64_t k) const
  {
    const glm::i64vec3 bricks = Levels.bricks(0);
    const auto at = [&](int axis, std::uint64_t stream) {
      return static_cast<std::int64_t>(inr::RandomBits(stream, k) %
                                       static_cast<std::uint64_t>(bricks[axis]));
    };
    return inr::KeyOf({0, {at(0, 1), at(1, 2), at(2, 3)}});
  }

  /// Inserts bricks all over the volume, then throws most of them out again.
  void work(std::uint64_t& done)
  {
    for (; done < 300; ++done) {
      const inr::BrickKey key = this->keyOf(done);
      this->Cache.beginFrame(done + 2);
      if (this->Cache.find(key) == inr::PageTable::Unmapped) {
        this->Cache.insert(key, this->Next.data());
      }
    }
    for (; done < 550; ++done) {
      if (this->Cache.oldestUse(inr::BrickCache::Pinned) != inr::BrickCache::Pinned) {
        this->Cache.evict(inr::BrickCache::Pinned);
      }
    }
  }

  /// Every slot has a brick, every brick a slot.
  void expectSound() const
  {
    std::int64_t found = 0;
    std::map<inr::BrickKey, int> seen;
    for (std::uint64_t k = 0; k < 300; ++k) {
      const inr::BrickKey key = this->keyOf(k);
      const std::int32_t slot = this->Cache.find(key);
      ASSERT_LT(slot, this->Cache.mapped());
      found += slot >= 0 && seen[key]++ == 0 ? 1 : 0;
    }
    EXPECT_EQ(found, this->Cache.mapped());
  }

  inr::Hierarchy Levels{{400, 400, 400}, 4};
  inr::BrickCache Cache;
  std::vector<float> Next = std::vector<float>(64, 0.5f);
};

void WorkThroughFailures(std::int64_t bytes)
{
  for (const For how : {For::Once, For::Good}) {
    bool failed = true;
    for (std::int64_t nth = 1; failed && !testing::Test::HasFailure(); ++nth) {
      Bricks bricks(bytes);
      std::uint64_t done = 0;
      failed = false;
      try {
        const FailingMemory memory(nth, how);
        bricks.work(done);
      } catch (const std::bad_alloc&) {
        failed = true;
      }
      bricks.expectSound();
      bricks.work(done);
      bricks.expectSound();
      EXPECT_EQ(done, 550u);
      ASSERT_LT(nth, 1000);
    }
  }
}

TEST(CacheWithoutMemory, StaysSoundWhereThereIsRoom) { WorkThroughFailures(4 << 20); }
TEST(CacheWithoutMemory, StaysSoundWhereBricksGoForOthers) { WorkThroughFailures(60 << 10); }

} // namespace test::cache_without_memory
