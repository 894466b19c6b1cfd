// SPDX-License-Identifier: BSD-3-Clause
//
// Memory that several caches of a device share, on the host.
#include "CUDA/Cache/CacheShares.h"
#include "CUDA/Cache/DeviceCache.h"
#include "CUDA/Render/DeviceStore.h"
#include "Core/Error.h"
#include "Core/Random.h"
#include "Testing/CUDA/CacheTools.h"
#include "Testing/CUDA/DrawingScene.h"
#include "Testing/CUDA/RuledInference.h"
#include "Testing/CUDA/SmallCache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace test::cache_shares {

using inr::BrickKey;
using inr::CachePrecision;
using inr::cuda::CacheShares;
using inr::cuda::CacheWish;

std::vector<CacheWish> RandomWishes(std::uint64_t seed)
{
  std::vector<CacheWish> wishes(1 + inr::RandomBits(seed, 0) % 7);
  for (std::size_t k = 0; k < wishes.size(); ++k) {
    const auto number = [&](std::uint64_t stream, std::int64_t most) {
      return static_cast<std::int64_t>(inr::RandomBits(seed, 10 * k + stream) %
                                       static_cast<std::uint64_t>(most));
    };
    CacheWish& wish = wishes[k];
    wish.least = number(1, number(6, 9) == 0 ? 40000 : 1000);
    wish.most = wish.least + number(2, number(3, 4) == 0 ? 10 : 100000);
    wish.limit = wish.most + number(4, 3) * number(5, 10000);
  }
  return wishes;
}

TEST(CacheShares, AreAllThatThereIsAndFair)
{
  int full = 0;
  int short_ = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const std::vector<CacheWish> wishes = RandomWishes(seed);
    const std::vector<std::int64_t> shares = inr::cuda::SharesOf(wishes);
    ASSERT_EQ(shares.size(), wishes.size());
    std::int64_t total = 0;
    std::int64_t needed = 0;
    std::int64_t taken = 0;
    std::int64_t fewest = std::int64_t{1} << 60; // of those who would like more
    std::int64_t most = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      total = std::max(total, wishes[k].limit);
      needed += wishes[k].least;
      taken += std::min(shares[k], wishes[k].most);
      ASSERT_GE(shares[k], wishes[k].least);
      const std::int64_t part = shares[k] - wishes[k].least;
      if (shares[k] < wishes[k].most) {
        fewest = std::min(fewest, part);
        most = std::max(most, part);
      } else {
        ASSERT_EQ(shares[k], wishes[k].limit);
      }
    }
    const bool all = fewest == std::int64_t{1} << 60;
    full += all ? 1 : 0;
    short_ += needed > total ? 1 : 0;
    ASSERT_LE(taken, std::max(total, needed));
    if (!all) {
      const auto count = static_cast<std::int64_t>(shares.size());
      ASSERT_GT(taken, std::max(total, needed) - count) << "nothing is left";
      ASSERT_LE(most - fewest, 1) << "alike";
      for (std::size_t k = 0; k < shares.size(); ++k) { // who has all that it wants wants no more
        ASSERT_LE(std::min(shares[k], wishes[k].most) - wishes[k].least, most + 1);
      }
    }
  }
  EXPECT_GT(full, 100);
  EXPECT_GT(short_, 10);
}

using RuledCache = inr::cuda::DeviceCache<HostMachine, RuledInference>;
using RuledStore = inr::cuda::DeviceStore<HostMachine, RuledCache>;

class SharingStores : public testing::Test
{
protected:
  static constexpr std::int64_t Limit = 200 << 10;

  std::shared_ptr<RuledStore> make(const glm::i64vec3& dims = {90, 80, 70},
                                   std::int64_t limit = Limit) const
  {
    return inr::cuda::MakeSharingStore<HostMachine, RuledCache>(
        this->Shares, HostLaunch(), RuledInference(), inr::Hierarchy(dims, 6),
        CachePrecision::Bits16, limit, {});
  }
  /// Has as many bricks come in as that, or as fit.
  static void fill(RuledStore& store, std::int64_t bricks)
  {
    const RuledStore::Turn turn(store);
    const std::int64_t most = std::min(bricks, store.cache.capacity());
    store.cache.beginFrame();
    const std::vector<BrickKey> keys =
        DifferentBricks(store.cache.hierarchy(), static_cast<std::size_t>(most));
    for (const BrickKey key : keys) {
      Ask(store.machine, store.cache.view(), WishesFor({key}));
      store.cache.load(1, true);
    }
  }
  static void use(RuledStore& store) { const RuledStore::Turn turn(store); }

  const std::shared_ptr<CacheShares> Shares = std::make_shared<CacheShares>();
};

TEST_F(SharingStores, StayWithinOneLimit)
{
  const auto first = this->make();
  const std::int64_t alone = first->cache.bytes();
  EXPECT_GT(alone, Limit * 9 / 10);
  EXPECT_EQ(first->bytes(), alone);
  fill(*first, 50);
  const auto second = this->make();
  EXPECT_LE(first->bytes(), Limit);
  EXPECT_EQ(first->bytes(), first->cache.bytes() + second->cache.bytes());
  EXPECT_EQ(second->bytes(), first->bytes());
  EXPECT_GT(first->cache.bytes(), Limit / 3);
  EXPECT_GT(second->cache.bytes(), Limit / 3);
  EXPECT_EQ(first->cache.mapped(), 1);
  fill(*first, 20);
  EXPECT_GT(first->cache.mapped(), 15);

  const auto larger = this->make({90, 80, 70}, 4 * Limit);
  EXPECT_GT(first->bytes(), 2 * Limit);
  EXPECT_LE(first->bytes(), 4 * Limit);
}

TEST_F(SharingStores, LeaveToOthersWhatASmallVolumeDoesNotNeed)
{
  const auto small = this->make({12, 12, 12});
  const std::int64_t needed = small->cache.bytes();
  const auto large = this->make();
  EXPECT_EQ(small->cache.bytes(), needed);
  EXPECT_GT(large->cache.bytes(), Limit * 9 / 10 - needed);
}

/// Whose bricks stay where more room is of no use.
TEST_F(SharingStores, GrowWhereOthersHaveGone)
{
  const auto first = this->make();
  const std::int64_t alone = first->cache.bytes();
  auto second = this->make();
  const std::int64_t together = first->cache.bytes();
  fill(*first, 10);
  const std::int64_t mapped = first->cache.mapped();
  second.reset();
  use(*first);
  EXPECT_EQ(first->cache.bytes(), together);
  EXPECT_EQ(first->cache.mapped(), mapped);
  fill(*first, 1000);
  use(*first);
  EXPECT_EQ(first->cache.bytes(), alone);

  second = this->make();
  first->cache.clear();
  use(*first);
  EXPECT_EQ(first->cache.bytes(), together);
  second.reset();
  use(*first); // nothing would be lost
  EXPECT_EQ(first->cache.bytes(), alone);
}

/// Nobody waits for who is drawing, which may be the same thread.
TEST_F(SharingStores, AdjustAtTheNextCallWhereOneIsInProgress)
{
  const auto first = this->make();
  std::shared_ptr<RuledStore> second;
  {
    const RuledStore::Turn turn(*first);
    second = this->make();
    EXPECT_GT(first->bytes(), Limit);
    EXPECT_LE(second->cache.bytes(), Limit / 2);
  }
  use(*first);
  EXPECT_LE(first->bytes(), Limit);
  EXPECT_THROW(
      {
        const RuledStore::Turn turn(*first);
        use(*first);
      },
      inr::Error);
  use(*first);
}

/// Where memory can be short.
struct ShortMachine : HostMachine
{
  explicit ShortMachine(std::shared_ptr<bool> isShort) : IsShort(std::move(isShort)) {}
  void requireFree(std::int64_t, const char*) const
  {
    if (*this->IsShort) {
      throw inr::Error(inr::ErrorCode::Device, "there is no memory");
    }
  }
  std::shared_ptr<bool> IsShort;
};

TEST_F(SharingStores, TryAgainWhereMemoryWasShort)
{
  using Cache = inr::cuda::DeviceCache<ShortMachine, RuledInference>;
  const auto isShort = std::make_shared<bool>(false);
  const auto first = inr::cuda::MakeSharingStore<ShortMachine, Cache>(
      this->Shares, isShort, RuledInference(), inr::Hierarchy({90, 80, 70}, 6),
      CachePrecision::Bits16, Limit, {});
  using Turn = inr::cuda::DeviceStore<ShortMachine, Cache>::Turn;
  *isShort = true;
  EXPECT_THROW(this->make(), inr::Error); // as it goes where the first one has to become smaller
  for (int k = 0; k < 2; ++k) {
    EXPECT_THROW(const Turn turn(*first), inr::Error);
    EXPECT_EQ(first->bytes(), 0);
  }
  *isShort = false;
  const Turn turn(*first);
  EXPECT_EQ(first->cache.mapped(), 1);
  EXPECT_GT(first->bytes(), Limit * 9 / 10);
}

/// In the middle of a picture, too: of few bricks at a time, and more than the cache holds.
TEST(SharingPictures, AreThoseOfCachesByThemselves)
{
  const auto other = std::make_shared<inr::Model>(*TrainedModel());
  for (const inr::RenderMode mode : Modes) {
    const Drawn alone = Draw(FullResolution(mode), RoomFor(Place::Host, 0));
    inr::Frame frame = FullResolution(mode);
    frame.timeLimit = 1e-9;
    inr::RendererOptions options = RoomFor(Place::Host, 60);
    options.cache.maximumRequests = 4;
    inr::Renderer renderer = RendererOf(options);
    inr::Image image;
    std::optional<inr::Renderer> second;
    std::set<std::int64_t> bytes;
    int calls = 0;
    for (bool complete = false; !complete && calls < 1000; ++calls) {
      complete = renderer.render(frame, image).complete;
      bytes.insert(renderer.cacheBytes());
      if (calls == 3 || calls == 11) { // comes, draws, and goes
        second.emplace(other, options);
        second->setTransferFunction(ColoursOf(other->volume));
        inr::Image its;
        second->render(frame, its);
      } else if (calls == 7 || calls == 15) {
        int more = 0;
        EXPECT_EQ(Finish(*second, frame, more).pixels, alone.rgba.pixels);
        second.reset();
      }
    }
    EXPECT_GT(calls, 16);
    EXPECT_GT(bytes.size(), 1u);
    EXPECT_EQ(image.pixels, alone.rgba.pixels);
    EXPECT_FALSE(renderer.acceleratorFailure());
  }
}

} // namespace test::cache_shares
