// SPDX-License-Identifier: BSD-3-Clause
//
// The cache in a device's memory, on the host, against simple ones.
#include "CUDA/DeviceCache.h"
#include "Core/Cache/BrickCache.h"
#include "Core/Error.h"
#include "Testing/CUDA/AskFor.h"
#include "Testing/CUDA/CacheModel.h"
#include "Testing/CUDA/EmulatedInference.h"
#include "Testing/CUDA/LateMachine.h"
#include "Testing/CUDA/RuledInference.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

namespace {

using inr::BrickKey;
using inr::CachePrecision;
using inr::Hierarchy;
using RuledCache = inr::cuda::DeviceCache<HostMachine, RuledInference>;

constexpr CachePrecision AllPrecisions[] = {CachePrecision::Float32, CachePrecision::Bits16,
                                            CachePrecision::Bits8};

std::vector<HostLaunch> Launches() { return {{3, false}, {3, true}, {1, false}, {7, true}}; }

BrickKey AnyBrick(const Hierarchy& levels, std::uint64_t seed)
{
  const auto draw = [&](std::uint64_t counter, std::int64_t count) {
    return static_cast<std::int64_t>(inr::RandomBits(seed, counter) %
                                     static_cast<std::uint64_t>(count));
  };
  const auto level = static_cast<int>(draw(0, levels.levels()));
  const glm::i64vec3& bricks = levels.bricks(level);
  return inr::KeyOf({level, {draw(1, bricks.x), draw(2, bricks.y), draw(3, bricks.z)}});
}

/// Different ones, the coarsest not among them.
std::vector<BrickKey> DifferentBricks(const Hierarchy& levels, std::size_t count)
{
  std::vector<BrickKey> keys;
  for (std::uint64_t seed = 0; keys.size() < count; ++seed) {
    const BrickKey key = AnyBrick(levels, seed);
    if (key != levels.coarsest() && std::find(keys.begin(), keys.end(), key) == keys.end()) {
      keys.push_back(key);
    }
  }
  return keys;
}

std::vector<Wish> WishesFor(const std::vector<BrickKey>& keys)
{
  std::vector<Wish> wishes;
  for (const BrickKey key : keys) {
    wishes.push_back({key, 1.0f});
  }
  return wishes;
}

/// What a slot holds is what Core's pool makes of the voxels.
void ExpectStored(const inr::BrickView& view, const Hierarchy& levels, CachePrecision precision,
                  const std::vector<float>& values)
{
  inr::BrickPool pool(precision, levels.voxelsPerBrick(), 1);
  pool.resize(1);
  pool.store(0, values.data());
  const inr::BrickView expected = pool.view(0);
  EXPECT_EQ(view.low, expected.low);
  EXPECT_FALSE(std::signbit(view.low)); // which of two zeros Core's is, depends on their order
  EXPECT_EQ(view.step, expected.step);
  const auto bytes =
      static_cast<std::size_t>(levels.voxelsPerBrick() * inr::BytesPerVoxel(precision));
  EXPECT_EQ(std::memcmp(view.voxels, expected.voxels, bytes), 0);
}

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

/// That hold so many bricks, or few more.
std::int64_t BytesFor(const Hierarchy& levels, CachePrecision precision, std::int64_t bricks)
{
  std::int64_t bytes = 14 << 10;
  while (inr::cuda::LayOutCache(levels, precision, bytes, 0).capacity < bricks) {
    bytes += 1 << 10;
  }
  return bytes;
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
class DeviceCacheTrace : public testing::TestWithParam<std::tuple<CachePrecision, int>>
{};

TEST_P(DeviceCacheTrace, IsThatOfASimpleCache)
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

INSTANTIATE_TEST_SUITE_P(Kernels, DeviceCacheTrace,
                         testing::Combine(testing::ValuesIn(AllPrecisions), testing::Range(0, 4)));

/// What infers beside the frames is as early as can be, or as late.
TEST(DeviceCache, LoadsBesideFrames)
{
  const Hierarchy levels({50, 40, 30}, 6);
  for (const HostLaunch& launch : Launches()) {
    for (const bool late : {false, true}) {
      LateMachine machine(false, launch);
      LateMachine beside(late, launch);
      inr::cuda::DeviceCache<LateMachine, RuledInference> cache(
          machine, {}, levels, CachePrecision::Bits16,
          BytesFor(levels, CachePrecision::Bits16, 60));
      CacheModel model(levels, cache.capacity());
      const std::int64_t atOnce =
          inr::cuda::LayOutCache(levels, CachePrecision::Bits16, cache.bytes(), 0).atOnce;
      std::vector<BrickKey> listed;
      std::int64_t wishes = 0;
      std::int64_t dropped = 0;
      for (std::uint64_t frame = 0; frame < 150; ++frame) {
        if (frame % 9 < 6) {
          cache.beginFrame();
          model.beginFrame();
        }
        AskBoth(machine, cache, model, frame);
        if (frame % 11 == 10) {
          UseAlmostAll(machine, cache, model);
        }
        if (cache.isLoading() && frame % 5 < 3) {
          EXPECT_EQ(cache.hasInferred(), !late);
          const auto loaded = cache.finishLoad();
          const CacheModel::Loaded expected = model.store(listed);
          ASSERT_EQ(loaded.requested, wishes) << frame;
          ASSERT_EQ(loaded.loaded, expected.loaded) << frame;
          ASSERT_EQ(loaded.full, expected.full) << frame;
          dropped += static_cast<std::int64_t>(listed.size()) - loaded.loaded;
        }
        if (!cache.isLoading()) {
          wishes = model.wishes();
          listed = model.list(std::min<std::int64_t>(atOnce, 9), true);
          cache.beginLoad(beside, 9, true);
          EXPECT_TRUE(cache.isLoading());
        }
        ExpectSame(cache, model);
      }
      EXPECT_GT(dropped, 0);
      cache.load(0, true);
      model.store(listed);
      ExpectSame(cache, model);
      ExpectContents(cache, model);
      EXPECT_FALSE(cache.isLoading());
    }
  }
}

TEST(DeviceCache, KeepsWhatTheFrameUsesAndTheCoarsest)
{
  const Hierarchy levels({50, 40, 30}, 6);
  HostMachine machine;
  RuledCache cache(machine, {}, levels, CachePrecision::Float32, 64 << 10);
  const auto capacity = static_cast<std::size_t>(cache.capacity());
  const std::vector<BrickKey> keys = DifferentBricks(levels, 2 * capacity);
  const std::vector<BrickKey> first(keys.begin(), keys.begin() + 5);
  Ask(machine, cache.view(), WishesFor(first));
  EXPECT_EQ(cache.load(1000, true).loaded, 5);
  for (int frame = 0; frame < 3; ++frame) {
    cache.beginFrame();
    Ask(machine, cache.view(), WishesFor(first));
    std::int64_t loaded = 0;
    for (std::size_t k = 5; k < keys.size(); k += 20) { // more than fit, a few at a time
      Ask(machine, cache.view(),
          WishesFor({keys.begin() + static_cast<std::ptrdiff_t>(k),
                     keys.begin() + static_cast<std::ptrdiff_t>(std::min(k + 20, keys.size()))}));
      loaded += cache.load(1000, true).loaded;
    }
    EXPECT_LE(loaded, cache.capacity() - 6);
    EXPECT_EQ(cache.mapped(), cache.capacity());
    for (const BrickKey key : first) {
      EXPECT_NE(cache.view().find(key), -1);
    }
    EXPECT_EQ(cache.view().find(levels.coarsest()), 0);
  }
  Ask(machine, cache.view(), WishesFor(keys));
  const RuledCache::Loaded none = cache.load(1000, true);
  EXPECT_TRUE(none.full);
  EXPECT_EQ(none.loaded, 0);
  cache.clear();
  EXPECT_EQ(cache.mapped(), 1);
  EXPECT_EQ(cache.view().find(levels.coarsest()), 0);
  EXPECT_EQ(cache.view().find(first[0]), -1);
}

TEST(DeviceCache, SaysThatWishesOverflowed)
{
  const Hierarchy levels({50, 40, 30}, 6);
  HostMachine machine;
  RuledCache cache(machine, {}, levels, CachePrecision::Float32, 64 << 10);
  const std::int64_t entries = cache.view().requests.mask + 1;
  Ask(machine, cache.view(), WishesFor(DifferentBricks(levels, 300)));
  const RuledCache::Loaded loaded = cache.load(4, true);
  EXPECT_LE(loaded.requested, entries);
  EXPECT_EQ(loaded.requested + loaded.overflowed, 300);
  EXPECT_EQ(loaded.loaded, 4);
  EXPECT_EQ(cache.load(4, true).requested, 0);
}

/// Memory follows the bricks that there are, not those of the volume.
TEST(DeviceCache, HoldsBricksOfTheLargestVolume)
{
  const std::int64_t side = 131072;
  const Hierarchy levels({side, side, side}, 16);
  HostMachine machine;
  RuledCache cache(machine, {}, levels, CachePrecision::Bits8, 1 << 20);
  EXPECT_LE(cache.view().pageMask + 1, 4 * cache.capacity());
  std::vector<BrickKey> keys;
  for (int level = 0; level < 4; ++level) {
    const glm::i64vec3 last = levels.bricks(level) - std::int64_t{1};
    keys.push_back(inr::KeyOf({level, last}));
    keys.push_back(inr::KeyOf({level, {0, last.y, 0}}));
    keys.push_back(inr::KeyOf({level, {last.x, 0, last.z / 2}}));
  }
  Ask(machine, cache.view(), WishesFor(keys));
  EXPECT_EQ(cache.load(1000, true).loaded, static_cast<std::int64_t>(keys.size()));
  for (const BrickKey key : keys) {
    const std::int32_t slot = cache.view().find(key);
    ASSERT_NE(slot, -1);
    ExpectStored(cache.view().view(slot), levels, CachePrecision::Bits8, RuledBrick(levels, key));
    EXPECT_EQ(cache.view().find(key + 1), -1);
  }
}

/// Counts what is allocated.
struct CountingMachine : HostMachine
{
  template <class T> Array<T> allocate(std::int64_t count) const
  {
    this->bytes += count * static_cast<std::int64_t>(sizeof(T));
    return HostMachine::allocate<T>(count);
  }
  mutable std::int64_t bytes = 0;
};

TEST(DeviceCache, StaysWithinItsBudget)
{
  const Hierarchy levels({500, 400, 300}, 10);
  for (const CachePrecision precision : AllPrecisions) {
    std::int64_t before = 0;
    for (const std::int64_t bytes : {100 << 10, 1 << 20, 3000000, 40 << 20}) {
      CountingMachine machine;
      const inr::cuda::DeviceCache<CountingMachine, RuledInference> cache(machine, {}, levels,
                                                                          precision, bytes);
      EXPECT_EQ(cache.bytes(), machine.bytes);
      EXPECT_LE(cache.bytes(), bytes);
      EXPECT_GT(cache.capacity(), before);
      before = cache.capacity();
    }
  }
  HostMachine machine; // no more than there are bricks
  const Hierarchy few({20, 20, 20}, 10);
  EXPECT_LT(RuledCache(machine, {}, few, CachePrecision::Bits8, 40 << 20).capacity(), 40);
}

/// As much as it says is enough, and a tenth less is not.
TEST(DeviceCache, SaysWhatItNeeds)
{
  const Hierarchy levels({500, 400, 300}, 40);
  HostMachine machine;
  for (const CachePrecision precision : AllPrecisions) {
    try {
      const RuledCache cache(machine, {}, levels, precision, 100 << 10);
      FAIL();
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::InvalidArgument);
      const std::string text = error.what();
      EXPECT_NE(text.find("0.09 MiB"), std::string::npos) << text;
      const double least = std::stod(text.substr(text.find("at least") + 9)) * (1 << 20);
      const RuledCache cache(machine, {}, levels, precision, static_cast<std::int64_t>(least) + 1);
      EXPECT_GE(cache.capacity(), inr::BrickCache::FewestBricks);
      EXPECT_THROW(
          RuledCache(machine, {}, levels, precision, static_cast<std::int64_t>(0.9 * least)),
          inr::Error);
    }
  }
}

/// Bricks of a network are those that a cache of Core's holds, those included that Core repairs.
TEST(DeviceCache, HoldsWhatTheModelGives)
{
  const Hierarchy levels({20, 14, 30}, 8);
  for (const inr::cuda::Precision kind :
       {inr::cuda::Precision::Half, inr::cuda::Precision::Float32}) {
    for (const bool overflows : {false, true}) {
      const auto parameters = RandomModel(SmallDescription());
      const float factor = kind == inr::cuda::Precision::Half ? 512.0f : 1e15f;
      for (float& parameter : parameters->parameters) {
        parameter *= overflows ? factor : 0.5f;
      }
      HostLaunch launch;
      launch.overflows = overflows;
      const auto model = std::make_shared<EmulatedModel>(parameters, kind, launch);
      HostMachine machine(launch);
      inr::cuda::DeviceCache<HostMachine, EmulatedInference> cache(
          machine, EmulatedInference(model), levels, CachePrecision::Bits16, 1 << 18);
      const std::vector<BrickKey> keys = DifferentBricks(levels, 5);
      Ask(machine, cache.view(), WishesFor(keys));
      const auto loaded = cache.load(1000, true);
      EXPECT_EQ(loaded.loaded, 5);
      EXPECT_EQ(loaded.repaired > 0, overflows);
      const EmulatedBricks source(model, levels);
      for (const BrickKey key : keys) {
        std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()));
        source.infer(&key, 1, values.data(), inr::Arena(1));
        ExpectStored(cache.view().view(cache.view().find(key)), levels, CachePrecision::Bits16,
                     values);
      }
    }
  }
}

} // namespace
