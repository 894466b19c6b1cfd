// SPDX-License-Identifier: BSD-3-Clause
//
// Many frames of the cache in a device's memory, on the host, against a simple one.
#include "CUDA/Cache/DeviceCache.h"
#include "Testing/CUDA/CacheModel.h"
#include "Testing/CUDA/CacheTools.h"
#include "Testing/CUDA/LazyMachine.h"
#include "Testing/CUDA/RuledInference.h"

#include <gtest/gtest.h>

#include <iterator>
#include <tuple>

namespace test::cache_traces {

using inr::BrickKey;
using inr::CachePrecision;
using inr::Hierarchy;
using RuledCache = inr::cuda::DeviceCache<HostMachine, RuledInference>;

std::vector<HostLaunch> Launches() { return {{3, false}, {3, true}, {1, false}, {7, true}}; }

/// Those bricks are mapped, and no other ones.
template <class Cache> void ExpectSame(const Cache& cache, const CacheModel& model)
{
  const inr::cuda::CacheView view = cache.view();
  ASSERT_EQ(cache.mapped(), static_cast<std::int64_t>(model.slots().size()));
  for (int level = 0; level < cache.hierarchy().levels(); ++level) {
    const glm::i64vec3& count = cache.hierarchy().bricks(level);
    for (std::int64_t k = 0; k < count.x * count.y * count.z; ++k) {
      const BrickKey key =
          inr::KeyOf({level, {k % count.x, k / count.x % count.y, k / (count.x * count.y)}});
      const auto place = model.slots().find(key);
      const std::int32_t slot = view.find(key);
      ASSERT_EQ(slot, place == model.slots().end() ? -1 : static_cast<int>(place->second)) << key;
    }
  }
}

template <class Cache> void ExpectContents(const Cache& cache, const CacheModel& model)
{
  for (const auto& [key, slot] : model.slots()) {
    ExpectStored(cache.view().view(static_cast<std::int32_t>(slot)), cache.hierarchy(),
                 cache.precision(), RuledBrick(cache.hierarchy(), key));
  }
}

/// A frame of random wishes for near and far bricks, by both.
template <class Machine, class Cache>
void AskBoth(Machine& machine, Cache& cache, CacheModel& model, std::uint64_t frame)
{
  std::vector<Wish> wishes;
  const std::uint64_t bricks = 1 + inr::RandomBits(frame, 1) % 60;
  for (std::uint64_t k = 0; k < 3 * bricks; ++k) {
    const std::uint64_t bits = inr::RandomBits(frame, 100 + k);
    const BrickKey key = AnyBrick(cache.hierarchy(), frame * 25 + bits % bricks);
    const float contribution = static_cast<float>(bits >> 40 & 3) / 16; // of which many are equal
    wishes.push_back({key, contribution});
    model.ask(key, contribution);
  }
  Ask(machine, cache.view(), wishes);
}

/// All that is mapped, but for two bricks, is used.
template <class Machine, class Cache>
void UseAlmostAll(Machine& machine, Cache& cache, CacheModel& model)
{
  std::vector<Wish> wishes;
  const std::map<BrickKey, std::size_t> slots = model.slots();
  for (auto slot = std::next(slots.begin(), 2); slot != slots.end(); ++slot) {
    wishes.push_back({slot->first, 1.0f});
    model.ask(slot->first, 1.0f);
  }
  Ask(machine, cache.view(), wishes);
}

/// Precision, and how the threads take turns.
class CacheTrace : public testing::TestWithParam<std::tuple<CachePrecision, int>>
{};

TEST_P(CacheTrace, IsThatOfASimpleCache)
{
  const auto [precision, launch] = GetParam();
  const Hierarchy levels({50, 40, 30}, 6);
  HostMachine machine(Launches()[static_cast<std::size_t>(launch)]);
  RuledCache cache(machine, {}, levels, precision, BytesFor(levels, precision, 40));
  CacheModel model(levels, cache.capacity());
  std::int64_t full = 0;
  std::int64_t evicted = 0;
  for (std::uint64_t frame = 0; frame < 150; ++frame) {
    if (frame % 8 < 5) { // else there are more rounds in one
      cache.beginFrame();
      model.beginFrame();
    }
    if (frame == 100) {
      cache.clear();
      model.clear();
    }
    AskBoth(machine, cache, model, frame);
    const std::int64_t mosts[] = {0, 7, 1000, 1000, 1000};
    const std::int64_t most = mosts[frame % 5];
    const std::int64_t wishes = model.wishes();
    const CacheModel::Loaded expected = model.load(most, frame % 7 > 0);
    const RuledCache::Loaded loaded = cache.load(most, frame % 7 > 0);
    ASSERT_EQ(loaded.requested, wishes) << frame;
    ASSERT_EQ(loaded.loaded, expected.loaded) << frame;
    ASSERT_EQ(loaded.full, expected.full) << frame;
    ASSERT_EQ(loaded.overflowed + loaded.repaired, 0) << frame;
    ExpectSame(cache, model);
    full += loaded.full ? 1 : 0;
    evicted += cache.mapped() == cache.capacity() ? loaded.loaded : 0;
  }
  ExpectContents(cache, model);
  EXPECT_GT(full, 1);
  EXPECT_GT(evicted, 2 * cache.capacity());
}

INSTANTIATE_TEST_SUITE_P(Kernels, CacheTrace,
                         testing::Combine(testing::ValuesIn(AllPrecisions), testing::Range(0, 4)),
                         [](const auto& info) {
                           const std::int64_t bytes = BytesPerVoxel(std::get<0>(info.param));
                           return std::to_string(8 * bytes) + "Bits" +
                                  std::to_string(std::get<1>(info.param));
                         });

/// Whether frames are drawn, and what infers beside them does so, as late as can be, or at once.
class CacheBesideFrames : public testing::TestWithParam<std::tuple<bool, bool, int>>
{
protected:
  static bool drawsLate() { return std::get<0>(GetParam()); }
  static bool infersLate() { return std::get<1>(GetParam()); }
  static HostLaunch launch()
  {
    return Launches()[static_cast<std::size_t>(std::get<2>(GetParam()))];
  }

  void beginFrame()
  {
    this->Cache.beginFrame();
    this->Simple.beginFrame();
  }

  void ask(std::uint64_t frame)
  {
    AskBoth(this->Where, this->Cache, this->Simple, frame);
    if (frame % 11 == 10) {
      UseAlmostAll(this->Where, this->Cache, this->Simple);
    }
  }

  void finishLoad()
  {
    EXPECT_EQ(this->Cache.hasInferred(), !infersLate());
    const auto loaded = this->Cache.finishLoad();
    const CacheModel::Loaded expected = this->Simple.store(this->Listed);
    EXPECT_EQ(loaded.requested, this->Wishes);
    EXPECT_EQ(loaded.loaded, expected.loaded);
    EXPECT_EQ(loaded.full, expected.full);
    this->Dropped += static_cast<std::int64_t>(this->Listed.size()) - loaded.loaded;
  }

  void beginLoad()
  {
    const std::int64_t atOnce =
        inr::cuda::LayOutCache(this->Levels, Precision, this->Cache.bytes(), {}).atOnce;
    this->Wishes = this->Simple.wishes();
    this->Listed = this->Simple.list(std::min<std::int64_t>(atOnce, 9), true);
    this->Cache.beginLoad(this->Beside, 9, true);
    EXPECT_TRUE(this->Cache.isLoading());
  }

  void expectSame()
  {
    this->Where.wait();
    ExpectSame(this->Cache, this->Simple);
  }

  static constexpr CachePrecision Precision = CachePrecision::Bits16;

  Hierarchy Levels{{50, 40, 30}, 6};
  LazyMachine Where{launch(), drawsLate()};
  LazyMachine Beside{launch(), infersLate()};
  inr::cuda::DeviceCache<LazyMachine, RuledInference> Cache{
      this->Where, {}, this->Levels, Precision, BytesFor(this->Levels, Precision, 60)};
  CacheModel Simple{this->Levels, this->Cache.capacity()};
  std::vector<BrickKey> Listed;
  std::int64_t Wishes = 0;
  std::int64_t Dropped = 0; ///< of what was listed
};

TEST_P(CacheBesideFrames, IsThatOfASimpleCache)
{
  for (std::uint64_t frame = 0; frame < 150; ++frame) {
    if (frame % 9 < 6) {
      this->beginFrame();
    }
    this->ask(frame);
    if (this->Cache.isLoading() && frame % 5 < 3) {
      this->finishLoad();
    }
    if (!this->Cache.isLoading()) {
      this->beginLoad();
    }
    this->expectSame();
    ASSERT_FALSE(HasFailure()) << frame;
  }
  EXPECT_GT(this->Dropped, 0);
  this->Cache.load(0, true); // finishes what was begun
  this->Simple.store(this->Listed);
  EXPECT_FALSE(this->Cache.isLoading());
  this->expectSame();
  ExpectContents(this->Cache, this->Simple);
}

TEST(CacheBeside, WaitsForWhatItHasBegunWhenItGoes)
{
  const Hierarchy levels({50, 40, 30}, 6);
  LazyMachine where;
  LazyMachine beside;
  {
    inr::cuda::DeviceCache<LazyMachine, RuledInference> cache(
        where, {}, levels, CachePrecision::Bits16, BytesFor(levels, CachePrecision::Bits16, 60));
    Ask(where, cache.view(), WishesFor(DifferentBricks(levels, 5)));
    cache.beginLoad(beside, 5, true);
    EXPECT_FALSE(beside.isIdle());
  }
  EXPECT_TRUE(beside.isIdle());
}

INSTANTIATE_TEST_SUITE_P(Kernels, CacheBesideFrames,
                         testing::Combine(testing::Bool(), testing::Bool(), testing::Range(0, 4)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param) ? "DrawsLate"
                                                                      : "DrawsAtOnce") +
                                  (std::get<1>(info.param) ? "InfersLate" : "InfersAtOnce") +
                                  std::to_string(std::get<2>(info.param));
                         });

} // namespace test::cache_traces
