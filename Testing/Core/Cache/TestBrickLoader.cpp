// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickLoader.h"
#include "Testing/Core/Cache/WholeBricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>

namespace test::brick_loader {

/// Layers of values that tell brick and layer; as slow as is wanted, and able to fail.
class CountingSource : public inr::BrickSource
{
public:
  CountingSource() : BrickSource(inr::Hierarchy({1000, 40, 40}, 8)) {}

  void inferLayer(inr::BrickKey key, std::int64_t z, float* values) const override
  {
    if (this->failing) {
      throw std::runtime_error("no such brick");
    }
    std::this_thread::sleep_for(this->delay);
    const std::int64_t layer = this->hierarchy().voxelsPerBrick() / 8;
    for (std::int64_t k = 0; k < layer; ++k) {
      values[k] = ValueOf(key, z * layer + k);
    }
    ++this->layers;
  }

  static float ValueOf(inr::BrickKey key, std::int64_t voxel)
  {
    return static_cast<float>(key % 1000) + 0.001f * static_cast<float>(voxel);
  }

  mutable std::atomic<int> layers{0};
  std::chrono::milliseconds delay{0};
  std::atomic<bool> failing{false};
};

std::vector<inr::BrickKey> Bricks(std::int64_t first, std::int64_t count)
{
  std::vector<inr::BrickKey> keys;
  for (std::int64_t k = 0; k < count; ++k) {
    keys.push_back(inr::KeyOf({0, {first + k, 0, 0}}));
  }
  return keys;
}

/// The same, three bricks at once.
class TogetherSource : public CountingSource
{
public:
  std::int64_t bricksAtOnce() const override { return 3; }

  void infer(const inr::BrickKey* keys, std::int64_t count, float* values,
             const inr::Arena& arena) const override
  {
    this->largest = std::max<std::int64_t>(this->largest, count);
    ++this->calls;
    CountingSource::infer(keys, count, values, arena);
  }

  mutable std::atomic<std::int64_t> largest{0};
  mutable std::atomic<int> calls{0};
};

/// What comes in, in that order; every value is checked.
std::vector<inr::BrickKey> Receive(inr::BrickLoader& loader)
{
  std::vector<inr::BrickKey> keys;
  loader.handOver([&](const inr::BrickPart& part, const float* values) {
    keys.push_back(part.key);
    for (std::int64_t k = 0; k < 512; ++k) {
      ASSERT_EQ(values[k], CountingSource::ValueOf(part.key, k));
    }
  });
  return keys;
}

constexpr double Forever = 1e9;

class BrickLoaderTest : public testing::TestWithParam<int>
{
protected:
  std::shared_ptr<CountingSource> Source = std::make_shared<CountingSource>();
};
INSTANTIATE_TEST_SUITE_P(Threads, BrickLoaderTest, testing::Values(0, 1, 3),
                         testing::PrintToStringParamName());

/// Whether it comes true within a time that even a busy machine keeps.
template <typename Condition> bool Soon(const Condition& condition)
{
  for (int k = 0; k < 6000 && !condition(); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return condition();
}

/// Another renderer of the same field may go at any time.
TEST_F(BrickLoaderTest, DoesNotWaitForWhatSomebodyElseHasTakenBack)
{
  inr::BrickLoader loader(this->Source, 1, 100);
  std::atomic<bool> done{false};
  std::thread other([&] {
    while (!done) {
      loader.request({});
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  });
  for (int k = 0; k < 3000; ++k) {
    loader.request(Whole(Bricks(0, 8)));
    loader.loadFor(1e-4);
    Receive(loader);
  }
  done = true;
  other.join();
}

TEST_P(BrickLoaderTest, LoadsWhatIsRequested)
{
  inr::BrickLoader loader(this->Source, GetParam(), 100);
  loader.request(Whole(Bricks(5, 20)));
  loader.loadFor(Forever);
  std::vector<inr::BrickKey> keys = Receive(loader);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(keys, Bricks(5, 20));
  EXPECT_EQ(this->Source->layers, 20 * 8);
  EXPECT_TRUE(Receive(loader).empty());
}

// 40 voxels in bricks of 8 that share a layer: the last brick has five layers.
TEST_P(BrickLoaderTest, InfersNoLayerBeyondTheVolume)
{
  inr::BrickLoader loader(this->Source, GetParam(), 100);
  const inr::BrickKey last = inr::KeyOf({0, {0, 0, 5}});
  loader.request({last});
  loader.loadFor(Forever);
  int received = 0;
  loader.handOver([&](const inr::BrickPart& part, const float* values) {
    EXPECT_EQ(part.key, last);
    for (std::int64_t k = 0; k < 512; ++k) {
      const std::int64_t inside = std::min<std::int64_t>(k, 4 * 64 + k % 64);
      ASSERT_EQ(values[k], CountingSource::ValueOf(part.key, inside));
    }
    ++received;
  });
  EXPECT_EQ(received, 1);
  EXPECT_EQ(this->Source->layers, 5);
}

TEST_P(BrickLoaderTest, WorksALayerAtLeastAndNoLongerThanItMay)
{
  this->Source->delay = std::chrono::milliseconds(2);
  inr::BrickLoader loader(this->Source, GetParam(), 100);
  loader.request(Whole(Bricks(0, 50)));
  loader.loadFor(0);
  EXPECT_TRUE(Soon([&] { return this->Source->layers >= 1; }));
  EXPECT_LE(this->Source->layers, 8);
  loader.loadFor(0.03);
  EXPECT_LT(this->Source->layers, 50 * 8);
}

TEST_F(BrickLoaderTest, DoesNotKeepACallerForALayer)
{
  this->Source->delay = std::chrono::seconds(3); // longer than a busy machine holds a thread up
  inr::BrickLoader loader(this->Source, 1, 100);
  loader.request(Whole(Bricks(0, 1)));
  loader.loadFor(0.001);
  EXPECT_EQ(this->Source->layers, 0);
}

TEST_P(BrickLoaderTest, HoldsNoMoreThanItHasRoomFor)
{
  inr::BrickLoader loader(this->Source, GetParam(), 3);
  EXPECT_EQ(inr::BrickLoader::bytesFor(this->Source->hierarchy(), 3), 3 * 512 * 4);
  loader.request(Whole(Bricks(0, 10)));
  std::size_t received = 0;
  for (int round = 0; round < 4; ++round) {
    loader.loadFor(Forever);
    const std::vector<inr::BrickKey> keys = Receive(loader);
    EXPECT_EQ(keys.size(), round < 3 ? 3U : 1U);
    received += keys.size();
  }
  EXPECT_EQ(received, 10U);
}

TEST_P(BrickLoaderTest, FinishesWhatIsBegunAndForgetsTheRest)
{
  this->Source->delay = std::chrono::milliseconds(1);
  inr::BrickLoader loader(this->Source, GetParam(), 100);
  loader.request(Whole(Bricks(0, 30)));
  loader.loadFor(0);
  std::vector<inr::BrickKey> wanted = Bricks(0, 1);
  wanted.push_back(inr::KeyOf({1, {0, 0, 0}}));
  loader.request(Whole(wanted));
  loader.loadFor(Forever);
  std::map<inr::BrickKey, int> received;
  for (const inr::BrickKey key : Receive(loader)) {
    ++received[key];
  }
  EXPECT_LT(received.size(), 30U);
  EXPECT_EQ(received[wanted[0]], 1); // not twice
  EXPECT_EQ(received[wanted[1]], 1);
}

TEST_P(BrickLoaderTest, SaysWhatWentWrongAndGoesOn)
{
  inr::BrickLoader loader(this->Source, GetParam(), 100);
  this->Source->failing = true;
  loader.request(Whole(Bricks(0, 3)));
  loader.loadFor(Forever);
  EXPECT_THROW(Receive(loader), std::runtime_error);
  this->Source->failing = false;
  loader.request(Whole(Bricks(0, 3)));
  loader.loadFor(Forever);
  EXPECT_EQ(Receive(loader).size(), 3U);
}

TEST_P(BrickLoaderTest, BeginsTogetherWhatIsBestInferredTogether)
{
  const auto source = std::make_shared<TogetherSource>();
  inr::BrickLoader loader(source, GetParam(), 5);
  loader.request(Whole(Bricks(5, 11)));
  std::vector<inr::BrickKey> keys;
  for (int round = 0; round < 3; ++round) { // of 5, 5 and 1, for which there is room
    loader.loadFor(Forever);
    const std::vector<inr::BrickKey> some = Receive(loader);
    keys.insert(keys.end(), some.begin(), some.end());
  }
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(keys, Bricks(5, 11));
  EXPECT_EQ(source->largest, 3);
  EXPECT_EQ(source->calls, 5); // 3 and 2, twice, and 1
}

/// A device that fails, upon which the CPU takes over, or that comes in: at any time between two
/// bricks.
class TogetherAtTimes : public TogetherSource
{
public:
  /// For so many looks at it, or from then on.
  TogetherAtTimes(int looks, bool atFirst) : AtFirst(atFirst), Left(looks) {}
  std::int64_t bricksAtOnce() const override { return (this->Left-- > 0) == this->AtFirst ? 3 : 0; }

private:
  bool AtFirst;
  mutable std::atomic<int> Left;
};

void ExpectAllBricks(const std::shared_ptr<TogetherAtTimes>& source, int threads)
{
  inr::BrickLoader loader(source, threads, 100);
  loader.request(Whole(Bricks(5, 20)));
  loader.loadFor(Forever);
  std::vector<inr::BrickKey> keys = Receive(loader);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(keys, Bricks(5, 20));
  EXPECT_GT(source->calls, 0);
}

TEST_P(BrickLoaderTest, ForgetsNothingWhenBricksAreNoLongerInferredTogether)
{
  for (int looks = 1; looks < 8; ++looks) {
    SCOPED_TRACE(looks);
    ExpectAllBricks(std::make_shared<TogetherAtTimes>(looks, true), GetParam());
  }
}

TEST_P(BrickLoaderTest, EndsWhatWasBegunInLayersWhenBricksAreInferredTogether)
{
  for (int looks = 1; looks < 20; ++looks) { // a brick has 8 layers
    SCOPED_TRACE(looks);
    ExpectAllBricks(std::make_shared<TogetherAtTimes>(looks, false), GetParam());
  }
}

/// An accelerator that is in the making until it is let go.
class SlowlyMade : public TogetherSource
{
public:
  std::int64_t bricksAtOnce() const override
  {
    this->asked = true;
    while (!this->made) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return 3;
  }

  mutable std::atomic<bool> asked{false};
  std::atomic<bool> made{false};
};

TEST(BrickLoader, IsPausedAndAskedWhileItsSourceIsBeingMade)
{
  const auto source = std::make_shared<SlowlyMade>();
  inr::BrickLoader loader(source, 1, 5);
  loader.resume();
  loader.request(Whole(Bricks(5, 3)));
  while (!source->asked) {
    std::this_thread::yield();
  }
  std::atomic<bool> answered{false};
  std::thread other([&] {
    loader.pause();
    EXPECT_EQ(loader.begun(), 0);
    EXPECT_EQ(loader.held(), 0);
    answered = true;
  });
  for (int k = 0; k < 5000 && !answered; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(answered);
  source->made = true;
  other.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(source->calls, 0); // paused meanwhile: nothing is begun
  loader.loadFor(Forever);
  EXPECT_EQ(Receive(loader).size(), 3u);
}

/// An accelerator that takes its time to say that there is none.
class SlowlyRefused : public CountingSource
{
public:
  std::int64_t bricksAtOnce() const override
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return 0;
  }
};

TEST(BrickLoader, HasAllThreadsOnTheFirstBrickWhoeverIsAsked)
{
  const auto source = std::make_shared<SlowlyRefused>();
  source->delay = std::chrono::milliseconds(3);
  inr::BrickLoader loader(source, 8, 100);
  loader.resume();
  loader.request(Whole(Bricks(5, 40)));
  std::int64_t most = 0;
  for (int look = 0; look < 40; ++look) {
    most = std::max(most, loader.begun());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_GT(most, 0);
  EXPECT_LE(most, 3); // one that is finished, one at work, one that is begun
}

TEST_P(BrickLoaderTest, OfBricksThatFailTogetherNoneComes)
{
  const auto source = std::make_shared<TogetherSource>();
  inr::BrickLoader loader(source, GetParam(), 100);
  source->failing = true;
  loader.request(Whole(Bricks(0, 2)));
  loader.loadFor(Forever);
  EXPECT_THROW(Receive(loader), std::runtime_error);
  EXPECT_EQ(loader.held(), 0);
  source->failing = false;
  loader.request(Whole(Bricks(0, 2)));
  loader.loadFor(Forever);
  EXPECT_EQ(Receive(loader).size(), 2U);
}

TEST_F(BrickLoaderTest, WorksOnlyBetweenResumeAndPause)
{
  inr::BrickLoader loader(this->Source, 2, 5);
  loader.request(Whole(Bricks(0, 40)));
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(this->Source->layers, 0);
  loader.resume();
  EXPECT_TRUE(Soon([&] { return this->Source->layers == 5 * 8; })); // as many as there is room for
  std::size_t received = 0;
  EXPECT_TRUE(Soon([&] { // handing over makes room
    received += Receive(loader).size();
    return received == 40;
  }));
  loader.pause();
  loader.request(Whole(Bricks(60, 5)));
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  EXPECT_EQ(this->Source->layers, 40 * 8);
}

TEST_F(BrickLoaderTest, EndsAfterTheLayersAtHand)
{
  this->Source->delay = std::chrono::milliseconds(5);
  int layers = 0;
  {
    inr::BrickLoader loader(this->Source, 2, 100);
    loader.request(Whole(Bricks(0, 100))); // 2 s
    loader.resume();
    EXPECT_TRUE(Soon([&] { return this->Source->layers > 0; }));
    layers = this->Source->layers;
  }
  EXPECT_LT(this->Source->layers, layers + 100);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(this->Source.use_count(), 1);
}

} // namespace test::brick_loader
