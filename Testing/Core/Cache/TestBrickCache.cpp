// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickCache.h"
#include "Core/Error.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <map>

namespace {

/// Eight-voxel bricks of a long volume, so that keys are numbers.
class BrickCacheTest : public testing::Test
{
protected:
  static inr::BrickKey key(std::int64_t k) { return inr::KeyOf({0, {k, 0, 0}}); }
  static std::int64_t bytesFor(std::int64_t bricks) { return bricks * 700; }

  void insert(inr::BrickCache& cache, std::int64_t k) const
  {
    const std::vector<float> values(8 * 2 * 2, static_cast<float>(k));
    EXPECT_TRUE(cache.insert(key(k), values.data()));
  }

  inr::Hierarchy Levels{{100000, 2, 2}, 8};
};

TEST_F(BrickCacheTest, StaysWithinItsBudget)
{
  for (const std::int64_t bytes : {8000, 100000, 5000000}) {
    for (const auto precision : {inr::CachePrecision::Float32, inr::CachePrecision::Bits8}) {
      const inr::BrickCache cache(this->Levels, precision, bytes);
      EXPECT_LE(cache.bytes(), bytes);
      EXPECT_GE(cache.bytes(), bytes / 2); // tables double
    }
  }
  EXPECT_THROW(inr::BrickCache(this->Levels, inr::CachePrecision::Float32, 2000), inr::Error);
}

TEST_F(BrickCacheTest, IsNoLargerThanTheVolume)
{
  const inr::Hierarchy small({16, 16, 16}, 8);
  const inr::BrickCache cache(small, inr::CachePrecision::Float32, std::int64_t{1} << 40);
  EXPECT_EQ(cache.capacity(), 27 + 1);
}

TEST_F(BrickCacheTest, NeverDropsABrickOfTheCurrentFrame)
{
  inr::BrickCache cache(this->Levels, inr::CachePrecision::Float32, 20000);
  cache.beginFrame();
  for (std::int64_t k = 0; k < cache.capacity(); ++k) {
    this->insert(cache, k);
  }
  const std::vector<float> values(32, 0.0f);
  EXPECT_FALSE(cache.insert(key(5000), values.data()));
  EXPECT_EQ(cache.find(key(5000)), inr::PageTable::Unmapped);
  EXPECT_EQ(cache.mapped(), cache.capacity());
  cache.beginFrame();
  for (std::int64_t k = 1; k < cache.capacity(); ++k) {
    cache.touch(cache.find(key(k)));
  }
  this->insert(cache, 5000); // in the place of the only one not touched
  EXPECT_EQ(cache.find(key(0)), inr::PageTable::Unmapped);
  EXPECT_FALSE(cache.insert(key(5001), values.data()));
}

TEST_F(BrickCacheTest, KeepsWhatIsPinned)
{
  inr::BrickCache cache(this->Levels, inr::CachePrecision::Float32, 20000);
  this->insert(cache, 7);
  cache.pin(key(7));
  for (std::int64_t k = 100; k < 1000; ++k) {
    cache.beginFrame();
    if (cache.find(key(7)) >= 0) {
      cache.touch(cache.find(key(7)));
    }
    this->insert(cache, k);
  }
  EXPECT_NE(cache.find(key(7)), inr::PageTable::Unmapped);
}

TEST_F(BrickCacheTest, EvictsTheLeastRecentlyUsedAsASimpleModelDoes)
{
  inr::BrickCache cache(this->Levels, inr::CachePrecision::Float32, 12000);
  std::map<std::int64_t, std::uint64_t> lastUse; // of mapped bricks
  for (std::uint64_t frame = 1; frame < 3000; ++frame) {
    cache.beginFrame();
    for (std::uint64_t use = 0; use < 3; ++use) {
      const auto k = static_cast<std::int64_t>(inr::RandomBits(frame, use) % 60);
      if (lastUse.count(k) != 0) {
        cache.touch(cache.find(key(k)));
        lastUse[k] = frame;
        continue;
      }
      const bool full = static_cast<std::int64_t>(lastUse.size()) == cache.capacity();
      std::uint64_t oldest = frame;
      for (const auto& entry : lastUse) {
        oldest = std::min(oldest, entry.second);
      }
      this->insert(cache, k);
      if (full) { // exactly one of the oldest is gone
        std::int64_t gone = -1;
        for (const auto& entry : lastUse) {
          if (cache.find(key(entry.first)) < 0) {
            ASSERT_EQ(gone, -1);
            ASSERT_EQ(entry.second, oldest);
            gone = entry.first;
          }
        }
        ASSERT_NE(gone, -1);
        lastUse.erase(gone);
      }
      lastUse[k] = frame;
    }
    for (const auto& entry : lastUse) {
      const std::int32_t slot = cache.find(key(entry.first));
      ASSERT_GE(slot, 0);
      ASSERT_EQ(static_cast<const float*>(cache.view(slot).voxels)[0],
                static_cast<float>(entry.first));
    }
  }
}

} // namespace
