// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickCache.h"
#include "Core/Error.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

namespace test::brick_cache {

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
      inr::BrickCache cache(this->Levels, precision, bytes);
      EXPECT_LT(cache.bytes(), bytes / 8);
      for (std::int64_t k = 0; k < 2 * cache.capacity(); ++k) {
        cache.beginFrame(static_cast<std::uint64_t>(k + 2));
        this->insert(cache, 4 * (k % 20000)); // a page each
      }
      EXPECT_LE(cache.bytes(), bytes);
      EXPECT_GE(cache.bytes(), bytes - 2 * bytes / cache.capacity());
    }
  }
  EXPECT_THROW(inr::BrickCache(this->Levels, inr::CachePrecision::Float32, 2000), inr::Error);
}

TEST_F(BrickCacheTest, TouchesWhatWasUsedSinceAFrame)
{
  inr::BrickCache cache(this->Levels, inr::CachePrecision::Float32, bytesFor(15));
  for (std::uint64_t frame = 2; frame < 7; ++frame) { // 2, 3, ... bricks in each of them
    cache.beginFrame(frame);
    for (std::uint64_t k = 0; k < frame; ++k) {
      this->insert(cache, static_cast<std::int64_t>(10 * frame + k));
    }
  }
  ASSERT_EQ(cache.mapped(), cache.capacity()); // the first ones have gone
  cache.beginFrame(7);
  EXPECT_EQ(cache.usedInFrame(), 0);
  cache.touchThoseSince(5);
  EXPECT_EQ(cache.usedInFrame(), 5 + 6);
  for (std::int64_t k = 0; k < cache.capacity() - 11; ++k) { // there is room for no more
    this->insert(cache, 100 + k);
  }
  const std::vector<float> values(8 * 2 * 2);
  EXPECT_FALSE(cache.insert(key(200), values.data()));
  for (std::int64_t k = 0; k < 5; ++k) {
    EXPECT_GE(cache.find(key(50 + k)), 0);
  }
}

TEST(BrickCacheMessages, SayHowMuchIsEnough)
{
  const inr::Hierarchy levels(glm::i64vec3(256), 40);
  constexpr double mebibyte = 1 << 20;
  std::string message;
  try {
    inr::BrickCache(levels, inr::CachePrecision::Bits16, 1 << 19);
  } catch (const inr::Error& error) {
    message = error.what();
  }
  EXPECT_NE(message.find("0.50 MiB"), std::string::npos) << message;
  const std::size_t advice = message.find("at least ");
  ASSERT_NE(advice, std::string::npos) << message;
  const double enough = std::stod(message.substr(advice + 9));
  EXPECT_NO_THROW(inr::BrickCache(levels, inr::CachePrecision::Bits16,
                                  static_cast<std::int64_t>(enough * mebibyte)));
  EXPECT_THROW(inr::BrickCache(levels, inr::CachePrecision::Bits16,
                               static_cast<std::int64_t>((enough - 0.02) * mebibyte)),
               inr::Error);
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
  cache.beginFrame(2);
  for (std::int64_t k = 0; k < cache.capacity(); ++k) {
    this->insert(cache, k);
  }
  const std::vector<float> values(32, 0.0f);
  EXPECT_FALSE(cache.insert(key(5000), values.data()));
  EXPECT_EQ(cache.find(key(5000)), inr::PageTable::Unmapped);
  EXPECT_EQ(cache.mapped(), cache.capacity());
  cache.beginFrame(3);
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
    cache.beginFrame(static_cast<std::uint64_t>(k));
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
    cache.beginFrame(frame + 1);
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

/// What the cache should do, on a set sorted by last use and slot.
class SimpleCache
{
public:
  explicit SimpleCache(std::int64_t slots)
  {
    for (std::int32_t slot = 0; slot < slots; ++slot) {
      this->Order.insert({0, slot});
      this->Owner.push_back(-1);
    }
  }

  std::int32_t find(std::int64_t k) const
  {
    const auto at = this->Slot.find(k);
    return at == this->Slot.end() ? inr::PageTable::Unmapped : at->second;
  }
  void use(std::int32_t slot, std::uint64_t frame)
  {
    const auto index = static_cast<std::size_t>(slot);
    this->Order.erase({this->LastUse[slot], slot});
    this->LastUse[slot] = std::max(this->LastUse[slot], frame);
    this->Order.insert({this->LastUse[slot], slot});
    ASSERT_GE(this->Owner[index], 0);
  }
  bool insert(std::int64_t k, std::uint64_t frame)
  {
    const auto [lastUse, slot] = *this->Order.begin();
    if (lastUse >= frame) {
      return false;
    }
    std::int64_t& owner = this->Owner[static_cast<std::size_t>(slot)];
    this->Slot.erase(owner);
    owner = k;
    this->Slot[k] = slot;
    this->use(slot, frame);
    return true;
  }
  std::int64_t mapped() const { return static_cast<std::int64_t>(this->Slot.size()); }

private:
  std::set<std::pair<std::uint64_t, std::int32_t>> Order;
  std::unordered_map<std::int32_t, std::uint64_t> LastUse;
  std::unordered_map<std::int64_t, std::int32_t> Slot; ///< of a brick
  std::vector<std::int64_t> Owner;
};

/// Random frames on a cache of about `slots`, of which each uses up to `uses` bricks out of
/// `bricks`: every brick must be in the very slot where the simple cache has it.
void CompareWithASimpleCache(std::int64_t slots, std::uint64_t bricks, std::uint64_t uses)
{
  const inr::Hierarchy levels({1500000, 2, 2}, 4);
  const auto key = [](std::int64_t k) { return inr::KeyOf({0, {k, 0, 0}}); };
  inr::BrickCache cache(levels, inr::CachePrecision::Bits8, slots * 400);
  SimpleCache model(cache.capacity());
  const std::vector<float> values(16, 0.5f);
  for (std::uint64_t frame = 2; frame < 200; ++frame) {
    cache.beginFrame(frame);
    const std::uint64_t inFrame = inr::RandomBits(1, frame) % uses;
    for (std::uint64_t use = 0; use < inFrame; ++use) {
      const auto k = static_cast<std::int64_t>(inr::RandomBits(frame, use) % bricks);
      const std::int32_t slot = cache.find(key(k));
      ASSERT_EQ(slot, model.find(k));
      if (slot < 0) {
        ASSERT_EQ(cache.insert(key(k), values.data()), model.insert(k, frame));
        ASSERT_EQ(cache.find(key(k)), model.find(k));
        continue;
      }
      cache.touch(slot);
      const bool pinned = use == 7 && frame % 5 == 0;
      model.use(slot, pinned ? ~std::uint64_t{0} : frame);
      if (pinned) {
        cache.pin(key(k));
      }
    }
    ASSERT_EQ(cache.mapped(), model.mapped());
  }
}

TEST(BrickCacheTraces, AFewSlots) { CompareWithASimpleCache(60, 150, 40); }
TEST(BrickCacheTraces, MoreUsedInAFrameThanThereAreSlots) { CompareWithASimpleCache(60, 500, 300); }
TEST(BrickCacheTraces, ManySlots) { CompareWithASimpleCache(20000, 60000, 6000); }
TEST(BrickCacheTraces, ManySlotsOfWhichMostAreInUse) { CompareWithASimpleCache(6000, 9000, 20000); }

} // namespace test::brick_cache
