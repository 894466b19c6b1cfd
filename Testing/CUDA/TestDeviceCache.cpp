// SPDX-License-Identifier: BSD-3-Clause
//
// The cache in a device's memory, on the host.
#include "CUDA/Cache/DeviceCache.h"
#include "Core/Cache/BrickCache.h"
#include "Core/Error.h"
#include "Testing/CUDA/CacheTools.h"
#include "Testing/CUDA/EmulatedInference.h"
#include "Testing/CUDA/RuledInference.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

namespace test::device_cache {

using inr::BrickKey;
using inr::CachePrecision;
using inr::Hierarchy;
using RuledCache = inr::cuda::DeviceCache<HostMachine, RuledInference>;

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

TEST(DeviceCache, LoadsAsLongAsItMay)
{
  const Hierarchy levels({50, 40, 30}, 6);
  HostMachine machine;
  RuledCache cache(machine, {}, levels, CachePrecision::Float32, 64 << 10);
  const std::vector<BrickKey> keys = DifferentBricks(levels, 40);
  Ask(machine, cache.view(), WishesFor(keys));
  int asked = 0;
  const std::int64_t loaded = cache.load(40, true, [&] { return ++asked < 3; }).loaded;
  EXPECT_EQ(asked, 3);
  Ask(machine, cache.view(), WishesFor(keys));
  const std::int64_t once = cache.load(40, true, [] { return false; }).loaded;
  EXPECT_GT(once, 0); // one launch's
  EXPECT_EQ(loaded, 3 * once);
  EXPECT_EQ(cache.load(40, true).requested, 0); // the others are forgotten
  Ask(machine, cache.view(), WishesFor(keys));
  cache.forgetRequests();
  EXPECT_EQ(cache.load(40, true).requested, 0);
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

/// Of any ranges, of [0, 1] and beyond, and some of none.
inr::MacroCells AnyCells(const glm::i64vec3& dims)
{
  inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  cells.provenance = inr::MacroCellProvenance::Decoded;
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const float low = 1.2f * inr::RandomUnit(1, k) - 0.2f;
    if (k % 7 != 0) {
      cells.ranges[k] = {low, low + 0.3f * inr::RandomUnit(2, k)};
    }
  }
  return cells;
}

/// As Core does. Bricks reach into several cells, and the coarsest into all.
TEST(DeviceCache, DividesTheRangesOfMacroCells)
{
  const glm::i64vec3 dims(64, 48, 40);
  const Hierarchy levels(dims, 17);
  auto cells = std::make_shared<inr::MacroCells>(AnyCells(dims));
  const auto field = inr::MakeEvaluator(RandomModel(SmallDescription())); // which nobody asks
  std::vector<BrickKey> keys = DifferentBricks(levels, 25);
  keys.push_back(levels.coarsest());
  for (const CachePrecision precision : AllPrecisions) {
    for (const bool hold : {true, false}) {
      cells->provenance =
          hold ? inr::MacroCellProvenance::Training : inr::MacroCellProvenance::File;
      HostMachine machine;
      RuledCache cache(machine, {}, levels, precision, 4 << 20, *cells);
      const auto truth = inr::MakeBrickSource(field, levels, hold ? cells : nullptr);
      Ask(machine, cache.view(), WishesFor(keys));
      ASSERT_EQ(cache.load(1000, true).loaded, 25);
      for (const BrickKey key : keys) {
        ExpectStored(cache.view().view(cache.view().find(key)), levels, precision,
                     RuledBrick(levels, key), truth->rangeOf(key));
      }
    }
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
      const inr::cuda::DeviceCache<CountingMachine, RuledInference> cache(
          machine, {}, levels, precision, bytes, AnyCells({100, 80, 60}));
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

/// Of another size it is as a new one.
TEST(DeviceCache, CanBeMadeSmallerAndLarger)
{
  const Hierarchy levels({50, 40, 30}, 6);
  HostMachine machine;
  HostMachine beside;
  for (const CachePrecision precision : AllPrecisions) {
    RuledCache cache(machine, {}, levels, precision, 64 << 10, AnyCells({10, 8, 6}));
    for (const std::int64_t bytes : {30 << 10, 300 << 10, 64 << 10}) {
      const std::vector<BrickKey> keys =
          DifferentBricks(levels, static_cast<std::size_t>(cache.capacity()) / 2);
      cache.beginFrame();
      Ask(machine, cache.view(), WishesFor(keys));
      cache.load(1000, true);
      Ask(machine, cache.view(), WishesFor(DifferentBricks(levels, keys.size() + 9)));
      cache.beginLoad(beside, 9, true);
      cache.resize(bytes);
      const RuledCache other(machine, {}, levels, precision, bytes, AnyCells({10, 8, 6}));
      EXPECT_EQ(cache.bytes(), other.bytes());
      EXPECT_EQ(cache.capacity(), other.capacity());
      EXPECT_EQ(cache.mapped(), 1);
      EXPECT_FALSE(cache.isLoading());
      EXPECT_EQ(cache.finishLoad().loaded, 0);
      EXPECT_EQ(cache.view().find(keys[0]), -1);
      ExpectStored(cache.view().view(cache.view().find(levels.coarsest())), levels, precision,
                   RuledBrick(levels, levels.coarsest()));
      Ask(machine, cache.view(), WishesFor({keys[0]}));
      EXPECT_EQ(cache.load(1000, true).loaded, 1);
      ExpectStored(cache.view().view(cache.view().find(keys[0])), levels, precision,
                   RuledBrick(levels, keys[0]));
    }
    const std::int64_t before = cache.bytes();
    EXPECT_THROW(cache.resize(1000), inr::Error);
    EXPECT_EQ(cache.bytes(), before);
    EXPECT_EQ(cache.mapped(), 2);
  }
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

class DeviceCacheOfModel : public testing::TestWithParam<std::tuple<inr::cuda::Precision, bool>>
{
protected:
  static bool overflows() { return std::get<1>(GetParam()); }
  static std::shared_ptr<const EmulatedModel> model()
  {
    const inr::cuda::Precision precision = std::get<0>(GetParam());
    const auto parameters = RandomModel(SmallDescription());
    const float large = precision == inr::cuda::Precision::Half ? 512.0f : 1e15f;
    for (float& parameter : parameters->parameters) {
      parameter *= overflows() ? large : 0.5f;
    }
    HostLaunch launch;
    launch.overflows = overflows();
    return std::make_shared<EmulatedModel>(parameters, precision, launch);
  }
};

/// Bricks of a network are those that a cache of Core's holds, those included that Core repairs;
/// loaded in several rounds, or beside.
TEST_P(DeviceCacheOfModel, HoldsWhatItGives)
{
  const Hierarchy levels({20, 14, 30}, 8);
  const std::vector<BrickKey> keys = DifferentBricks(levels, 5);
  const EmulatedBricks source(model(), levels);
  for (const bool isBeside : {false, true}) {
    HostMachine machine;
    HostMachine beside;
    inr::cuda::DeviceCache<HostMachine, EmulatedInference> cache(
        machine, EmulatedInference(model()), levels, CachePrecision::Bits16,
        isBeside ? 1 << 18 : 1 << 15);
    Ask(machine, cache.view(), WishesFor(keys));
    if (isBeside) {
      cache.beginLoad(beside, 1000, true);
    }
    const auto loaded = isBeside ? cache.finishLoad() : cache.load(1000, true);
    EXPECT_EQ(loaded.loaded, 5);
    EXPECT_EQ(loaded.repaired > 0, overflows());
    for (const BrickKey key : keys) {
      std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()));
      source.infer(&key, 1, values.data(), inr::Arena(1));
      ASSERT_NE(cache.view().find(key), -1);
      ExpectStored(cache.view().view(cache.view().find(key)), levels, CachePrecision::Bits16,
                   values);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, DeviceCacheOfModel,
                         testing::Combine(testing::Values(inr::cuda::Precision::Half,
                                                          inr::cuda::Precision::Float32),
                                          testing::Bool()),
                         [](const auto& info) {
                           const bool half = std::get<0>(info.param) == inr::cuda::Precision::Half;
                           const bool overflows = std::get<1>(info.param);
                           return std::string(half ? "Half" : "Float32") +
                                  (overflows ? "ThatOverflows" : "");
                         });

} // namespace test::device_cache
