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
#include <new>
#include <optional>
#include <string>
#include <utility>
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

/// The memory of a machine.
struct Memory
{
  std::int64_t free = std::int64_t{1} << 40;
  std::int64_t reserve = 0; ///< that stays for others
  bool fails = false;       ///< to be had
  int failingReads = 0;     ///< so many from here on
  int takenBetween = 0;     ///< as often from here on, after it was asked whether there is enough
};

/// One whose memory can be short.
class MeteredMachine : public HostMachine
{
public:
  template <class T> class Array : public HostMachine::Array<T>
  {
  public:
    Array(std::shared_ptr<Memory> memory, std::int64_t count)
        : HostMachine::Array<T>(count), From(std::move(memory)), Bytes(count * sizeof(T))
    {
      if (this->From->fails || this->From->free < this->Bytes) {
        throw inr::Error(inr::ErrorCode::Device, "out of memory");
      }
      if (this->From->takenBetween > 0) {
        --this->From->takenBetween;
        throw inr::Error(inr::ErrorCode::Device, "out of memory since");
      }
      this->From->free -= this->Bytes;
    }
    Array(Array&& other) noexcept
        : HostMachine::Array<T>(std::move(other)), From(std::move(other.From)), Bytes(other.Bytes)
    {}
    ~Array() { this->From ? void(this->From->free += this->Bytes) : void(); }

  private:
    std::shared_ptr<Memory> From;
    std::int64_t Bytes;
  };

  explicit MeteredMachine(std::shared_ptr<Memory> memory) : Has(std::move(memory)) {}
  template <class T> Array<T> allocate(std::int64_t count) const
  {
    return Array<T>(this->Has, std::max<std::int64_t>(count, 1));
  }
  void requireFree(std::int64_t bytes, const char* what) const
  {
    if (this->Has->fails || this->Has->free - this->Has->reserve < bytes) {
      throw inr::Error(inr::ErrorCode::Device, std::string(what) + " does not fit");
    }
  }
  template <class T> void toHost(T* to, const T* from, std::int64_t count) const
  {
    if (this->Has->failingReads > 0) {
      --this->Has->failingReads;
      throw std::bad_alloc();
    }
    HostMachine::toHost(to, from, count);
  }

private:
  std::shared_ptr<Memory> Has;
};

class SharingStores : public testing::Test
{
protected:
  using Cache = inr::cuda::DeviceCache<MeteredMachine, RuledInference>;
  using Store = inr::cuda::DeviceStore<MeteredMachine, Cache>;
  static constexpr std::int64_t Limit = 200 << 10;

  std::shared_ptr<Store> make(const glm::i64vec3& dims = {90, 80, 70},
                              std::int64_t limit = Limit) const
  {
    return inr::cuda::MakeSharingStore<MeteredMachine, Cache>(
        this->Shares, this->Machines, RuledInference(), inr::Hierarchy(dims, 6),
        CachePrecision::Bits16, limit, {}, this->Machines->free / 2);
  }
  static void use(Store& store) { const Store::Turn turn(store); }
  /// Has as many bricks come in as that, or as fit.
  static void fill(Store& store, std::int64_t bricks = 1000)
  {
    const Store::Turn turn(store);
    const std::int64_t most = std::min(bricks, store.cache.capacity() - 1); // and the coarsest
    store.cache.beginFrame();
    for (const BrickKey key :
         DifferentBricks(store.cache.hierarchy(), static_cast<std::size_t>(most))) {
      Ask(store.machine, store.cache.view(), WishesFor({key}));
      store.cache.load(1, true);
    }
  }

  const std::shared_ptr<CacheShares> Shares = std::make_shared<CacheShares>();
  const std::shared_ptr<Memory> Machines = std::make_shared<Memory>();
};

TEST_F(SharingStores, StayWithinOneLimit)
{
  const std::int64_t free = this->Machines->free;
  const auto first = this->make();
  const std::int64_t alone = first->cache.bytes();
  EXPECT_GT(alone, Limit * 9 / 10);
  EXPECT_EQ(first->bytes(), alone);
  fill(*first, 50);
  const auto second = this->make();
  use(*second); // a cache that nobody looks at gives, too
  EXPECT_LE(first->bytes(), Limit);
  EXPECT_EQ(first->bytes(), first->cache.bytes() + second->cache.bytes());
  EXPECT_NEAR(free - this->Machines->free, first->bytes(), 16); // of two empty arrays
  EXPECT_GT(first->cache.bytes(), Limit / 3);
  EXPECT_GT(second->cache.bytes(), Limit / 3);
  EXPECT_EQ(first->cache.mapped(), 1);
  fill(*first, 20);
  EXPECT_GT(first->cache.mapped(), 15);

  const auto larger = this->make({90, 80, 70}, 4 * Limit);
  use(*larger);
  EXPECT_GT(first->bytes(), 2 * Limit);
  EXPECT_LE(first->bytes(), 4 * Limit);
}

TEST_F(SharingStores, LeaveToOthersWhatASmallVolumeDoesNotNeed)
{
  const auto small = this->make({12, 12, 12});
  const std::int64_t needed = small->cache.bytes();
  const auto large = this->make();
  use(*large);
  EXPECT_EQ(small->cache.bytes(), needed);
  EXPECT_GT(large->cache.bytes(), Limit * 9 / 10 - needed);
}

/// Whose bricks stay where more room is of no use.
TEST_F(SharingStores, GrowWhereOthersHaveGone)
{
  const auto first = this->make();
  const std::int64_t alone = first->cache.bytes();
  auto second = this->make();
  use(*second);
  const std::int64_t together = first->cache.bytes();
  fill(*first, 10);
  const std::int64_t mapped = first->cache.mapped();
  second.reset();
  use(*first);
  EXPECT_EQ(first->cache.bytes(), together);
  EXPECT_EQ(first->cache.mapped(), mapped);
  fill(*first);
  use(*first);
  EXPECT_EQ(first->cache.bytes(), alone);

  second = this->make();
  use(*second);
  EXPECT_EQ(first->cache.bytes(), together);
  second.reset();
  use(*first); // nothing would be lost
  EXPECT_EQ(first->cache.bytes(), alone);
}

/// And where it is little, or none at all.
TEST_F(SharingStores, DoNotGrowForAFewBricks)
{
  constexpr std::int64_t limit = Limit * 3 / 2; // well between two sizes of the page table
  const auto first = this->make({90, 80, 70}, limit);
  auto small = this->make({12, 12, 12}, limit);
  use(*small);
  fill(*first);
  const std::int64_t bricks = first->cache.mapped();
  EXPECT_EQ(bricks, first->cache.capacity());
  small.reset();
  EXPECT_GT(first->cache.capacityWithin(limit), bricks);
  use(*first);
  EXPECT_EQ(first->cache.mapped(), bricks);
}

TEST_F(SharingStores, DoNotGrowWhereAllIsThere)
{
  constexpr std::int64_t limit = 100 << 10;
  const auto whole = this->make({24, 18, 18}, limit);
  const std::int64_t all = whole->cache.capacity();
  const std::int64_t alone = whole->cache.bytes();
  std::vector<std::shared_ptr<Store>> others;
  while (whole->cache.bytes() == alone && others.size() < 40) {
    others.push_back(this->make({7, 7, 7}, limit));
    use(*whole);
  }
  ASSERT_EQ(whole->cache.capacity(), all) << "smaller buffers, as many bricks: " << others.size();
  fill(*whole);
  others.clear();
  use(*whole);
  EXPECT_EQ(whole->cache.mapped(), all);
  EXPECT_LT(whole->cache.bytes(), alone);
}

/// As those of the time steps of a series are: the others keep their bricks.
TEST_F(SharingStores, AreLeftAloneWhereOneTakesTheOthersPlace)
{
  const auto still = this->make();
  auto step = this->make();
  use(*step);
  fill(*still);
  fill(*step);
  const std::int64_t bricks = still->cache.mapped();
  const std::int64_t bytes = step->cache.bytes();
  for (int k = 0; k < 5; ++k) {
    step = this->make(); // before the one before goes
    fill(*step);
    use(*still);
    EXPECT_EQ(still->cache.mapped(), bricks);
    EXPECT_EQ(step->cache.bytes(), bytes);
    EXPECT_EQ(step->cache.mapped(), step->cache.capacity());
  }
}

/// Nobody waits for who is drawing, which may be the same thread.
TEST_F(SharingStores, AdjustAtTheNextCallWhereOneIsInProgress)
{
  const auto first = this->make();
  std::shared_ptr<Store> second;
  {
    const Store::Turn turn(*first);
    second = this->make();
    use(*second);
    EXPECT_GT(first->bytes(), Limit);
    EXPECT_LE(second->cache.bytes(), Limit / 2);
  }
  use(*second); // whoever draws next, even where the first one never does again
  EXPECT_LE(first->bytes(), Limit);
  EXPECT_THROW(
      {
        const Store::Turn turn(*first);
        use(*first);
      },
      inr::Error);
  use(*first);
}

/// Growing is no need, and who becomes smaller needs nothing.
TEST_F(SharingStores, WorkOnWhereOthersHaveTakenTheMemory)
{
  const auto first = this->make();
  auto second = this->make();
  use(*second);
  fill(*first);
  const std::int64_t bytes = first->cache.bytes();
  const std::int64_t bricks = first->cache.mapped();
  second.reset();
  const std::int64_t free = std::exchange(this->Machines->free, 1000);
  use(*first);
  EXPECT_EQ(first->cache.bytes(), bytes);
  EXPECT_EQ(first->cache.mapped(), bricks);

  this->Machines->free = free; // which is noticed after a while
  for (int k = 0; k < 200; ++k) {
    use(*first);
  }
  EXPECT_GT(first->cache.bytes(), bytes);
  second = this->make();
  const auto third = this->make();
  this->Machines->reserve = free;
  use(*first);
  EXPECT_LT(first->cache.bytes(), bytes);
  EXPECT_LE(first->bytes(), Limit);
  EXPECT_THROW(this->make(), inr::Error);
  use(*first);
}

/// Who comes finds little free beside the others, which give theirs only then.
TEST_F(SharingStores, BeginWithWhatIsFree)
{
  const auto first = this->make();
  this->Machines->free = Limit / 4;
  const auto second = this->make();
  EXPECT_LE(second->cache.bytes(), Limit / 8);
  use(*second);
  EXPECT_GT(second->cache.bytes(), Limit / 3);
  EXPECT_LE(first->bytes(), Limit);
  EXPECT_EQ(second->cache.mapped(), 1);

  this->Machines->free = 1000;
  EXPECT_THROW(this->make(), inr::Error) << "not even eight bricks";
  use(*first);
}

/// And who fails leaves the others alone.
TEST_F(SharingStores, TryAgainWhereThereWasNoMemory)
{
  const auto first = this->make();
  const std::int64_t alone = first->cache.bytes();
  auto second = this->make();
  this->Machines->fails = true;
  EXPECT_NO_THROW(use(*second));
  for (int k = 0; k < 2; ++k) {
    EXPECT_THROW(const Store::Turn turn(*first), inr::Error);
    EXPECT_EQ(first->cache.mapped(), 0);
    EXPECT_EQ(first->bytes(), second->cache.bytes()) << "what is not there counts as nothing";
  }
  this->Machines->fails = false;
  second.reset();
  this->Machines->reserve = this->Machines->free - alone / 2;
  EXPECT_THROW(use(*first), inr::Error) << "the reserve is for others";
  this->Machines->reserve = 0;
  use(*first);
  EXPECT_EQ(first->cache.mapped(), 1);
  EXPECT_EQ(first->bytes(), alone);
}

/// Of which it is not said before.
TEST_F(SharingStores, KeepTheirSizeWhereMemoryGoesWhileTheyGrow)
{
  const auto first = this->make();
  auto second = this->make();
  use(*second);
  const std::int64_t bytes = first->cache.bytes();
  second.reset();
  this->Machines->takenBetween = 1;
  EXPECT_NO_THROW(use(*first));
  EXPECT_EQ(this->Machines->takenBetween, 0);
  EXPECT_EQ(first->cache.bytes(), bytes);
  EXPECT_EQ(first->bytes(), bytes);
  EXPECT_EQ(first->cache.mapped(), 1);
  fill(*first);
  for (int k = 0; k < 200; ++k) {
    use(*first);
  }
  EXPECT_GT(first->cache.bytes(), bytes);
}

/// After the memory was to be had, too, and whatever it was that failed.
TEST_F(SharingStores, TryAgainWhereTheCoarsestBrickDidNotComeIn)
{
  const auto first = this->make();
  auto second = this->make();
  this->Machines->failingReads = 1;
  EXPECT_NO_THROW(use(*second));
  EXPECT_EQ(this->Machines->failingReads, 0);
  use(*first);
  EXPECT_EQ(first->cache.mapped(), 1);
  fill(*first, 20);
  EXPECT_GT(first->cache.mapped(), 15);
}

TEST(CacheShares, AreOneForEachGpu)
{
  const std::shared_ptr<CacheShares> shares = CacheShares::ofGpu(3);
  EXPECT_EQ(CacheShares::ofGpu(3), shares);
  EXPECT_NE(CacheShares::ofGpu(4), shares);
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
    bool wasResized = false; // which costs its bricks
    int calls = 0;
    for (bool complete = false; !complete && calls < 1000; ++calls) {
      const std::int64_t bricks = renderer.cachedBricks();
      complete = renderer.render(frame, image).complete;
      wasResized |= renderer.cachedBricks() < bricks;
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
    EXPECT_TRUE(wasResized);
    EXPECT_EQ(image.pixels, alone.rgba.pixels);
    EXPECT_FALSE(renderer.acceleratorFailure());
  }
}

} // namespace test::cache_shares
