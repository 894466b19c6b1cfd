// SPDX-License-Identifier: BSD-3-Clause
//
// Rays that wait for bricks: by windows, in turns, and with room for few.
#include "CUDA/Render/WindowedRays.h"
#include "Testing/CUDA/HostLaunchDefinition.h"
#include "Testing/CUDA/HostMachine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <vector>

namespace test::windowed_rays {

constexpr int Width = 21;
constexpr int Height = 13;
constexpr int Needed = 3;   ///< bricks that a ray has to have met, one after another
constexpr int Samples = 50; ///< in each of them

/// Bricks as numbers: what is there, what was asked for and what was used.
struct FewBricks
{
  std::int64_t room;
  std::set<int> there;
  std::set<int> used; ///< by the present frame
  std::set<int> wanted;
  int clears = 0;

  struct Loaded
  {
    std::int64_t loaded;
    bool full;
  };

  FewBricks* view() { return this; }
  void beginFrame() { this->used.clear(); }
  std::int64_t capacity() const { return this->room; }
  void clear()
  {
    ++this->clears;
    this->there.clear();
  }
  void forgetRequests() { this->wanted.clear(); }
  Loaded load(std::int64_t most, bool, const std::function<bool()>&)
  {
    Loaded loaded{0, false};
    for (const int brick : this->wanted) {
      if (loaded.loaded == most || !this->makeRoom()) {
        loaded.full = true;
        break;
      }
      this->there.insert(brick);
      this->used.insert(brick);
      ++loaded.loaded;
    }
    this->wanted.clear();
    return loaded;
  }

private:
  bool makeRoom()
  {
    if (static_cast<std::int64_t>(this->there.size()) < this->room) {
      return true;
    }
    for (const int brick : this->there) {
      if (this->used.count(brick) == 0) {
        this->there.erase(brick);
        return true;
      }
    }
    return false;
  }
};

/// Of a ray that waits, in bytes that nobody initialises.
struct Stage
{
  std::int64_t pixel;
  int samples;
};

/// A kernel as WindowedRays wants them.
struct CountSamples
{
  static constexpr int Threads = inr::cuda::WarpSize;
  static constexpr int Turns[] = {32, 64, inr::cuda::RayLists::NoLimit};

  FewBricks* cache;
  inr::cuda::RayLists lists;
  bool begin;
  Stage* progress;
  std::vector<int>* ended; ///< of each pixel, how often
  bool stops;              ///< for what is not there

  template <class Block> void operator()(Block& block) const
  {
    this->lists.forEach(block,
                        [&](std::uint32_t ray, std::int64_t pixel) { this->advance(ray, pixel); });
  }

private:
  void advance(std::uint32_t ray, std::int64_t pixel) const
  {
    Stage& stage = this->progress[ray];
    if (this->begin) {
      stage = {pixel, 0};
    }
    EXPECT_EQ(stage.pixel, pixel) << "another ray's progress";
    for (int taken = 0; stage.samples < Needed * Samples; ++stage.samples, ++taken) {
      if (taken == this->lists.most) {
        this->lists.list(ray, false);
        return;
      }
      const int brick = static_cast<int>(pixel) % 7 + 7 * (stage.samples / Samples);
      if (this->stops && this->cache->there.count(brick) == 0) {
        this->cache->wanted.insert(brick);
        this->lists.list(ray, true);
        return;
      }
      this->cache->used.insert(brick);
    }
    ++(*this->ended)[static_cast<std::size_t>(pixel)];
  }
};

using Rays = inr::cuda::WindowedRays<HostMachine, FewBricks, Stage>;

CountSamples Kernel(std::vector<int>& ended, bool stops)
{
  CountSamples kernel{};
  kernel.ended = &ended;
  kernel.stops = stops;
  return kernel;
}

const inr::cuda::RayOrder All{Width, Height, nullptr, 0};

void RunToEnd(Rays& rays, const CountSamples& kernel, const inr::cuda::RayOrder& order,
              const std::function<bool()>& keepGoing)
{
  rays.begin(order);
  rays.goOn(kernel, inr::WorkLimit(0, false), 1, keepGoing, [] { return true; });
  EXPECT_TRUE(rays.done());
}

/// Supplies of a cache of 8 bricks that never has room for all.
TEST(RayThrottle, LetsFewerGoOnWhereThereIsNoRoomDownToOne)
{
  inr::cuda::RayThrottle throttle;
  throttle.beginWindow(100);
  EXPECT_EQ(throttle.atOnce(100), 100);
  for (const std::int64_t atOnce : {50, 25, 12, 6, 3, 1, 1}) {
    throttle.adapt({8, 8, true}, 100);
    EXPECT_EQ(throttle.atOnce(100), atOnce);
  }
}

TEST(RayThrottle, LetsMoreGoOnOnlyWhenARayHasEnded)
{
  inr::cuda::RayThrottle throttle;
  throttle.beginWindow(100);
  throttle.adapt({8, 8, true}, 100);
  throttle.adapt({8, 8, false}, 100); // there was room, but nobody has ended
  EXPECT_EQ(throttle.atOnce(100), 50);
  throttle.adapt({8, 8, false}, 99);
  EXPECT_EQ(throttle.atOnce(99), 99); // as many as there are
  throttle.adapt({8, 8, true}, 98);   // crowded, but much came in, and one has ended
  EXPECT_EQ(throttle.atOnce(98), 98);
  throttle.adapt({1, 8, true}, 97); // too little for so many
  EXPECT_EQ(throttle.atOnce(97), 48);
  throttle.beginWindow(30);
  EXPECT_EQ(throttle.atOnce(30), 30);
}

/// Whatever the size of a window, of which the last one is smaller.
TEST(WindowedRays, EndEveryRayOnce)
{
  for (const bool backward : {false, true}) {
    HostLaunch launch;
    launch.backward = backward;
    HostMachine machine(launch);
    for (const std::int64_t window : {1, 5, 64, 100, 1000}) {
      for (const std::int64_t room : {1, 2, 9, 100}) {
        SCOPED_TRACE(std::to_string(window) + " " + std::to_string(room));
        FewBricks bricks{room, {}, {}, {}};
        Rays rays(machine, bricks, window);
        std::vector<int> ended(static_cast<std::size_t>(Width * Height), 0);
        int asked = 0;
        RunToEnd(rays, Kernel(ended, true), All, [&] { return ++asked < 100000; });
        EXPECT_EQ(ended, std::vector<int>(ended.size(), 1));
        rays.runOnce(Kernel(ended, false), All, {});
        EXPECT_EQ(ended, std::vector<int>(ended.size(), 2));
      }
    }
  }
}

/// Those of a list of pixels, and no other.
TEST(WindowedRays, EndThoseOfAList)
{
  HostMachine machine;
  std::vector<std::uint32_t> pixels;
  std::vector<int> expected(static_cast<std::size_t>(Width * Height), 0);
  for (std::uint32_t pixel = 3; pixel < expected.size(); pixel += 7) {
    pixels.push_back(pixel);
    expected[pixel] = 1;
  }
  const inr::cuda::RayOrder order{Width, Height, pixels.data(),
                                  static_cast<std::int64_t>(pixels.size())};
  for (const std::int64_t window : {4, 100}) {
    FewBricks bricks{4, {}, {}, {}};
    Rays rays(machine, bricks, window);
    std::vector<int> ended(expected.size(), 0);
    RunToEnd(rays, Kernel(ended, true), order, {});
    EXPECT_EQ(ended, expected);
  }
}

/// There is memory for as many as wait, however few there were before.
TEST(WindowedRays, MayBeMoreThanBefore)
{
  HostMachine machine;
  FewBricks bricks{4, {}, {}, {}};
  Rays rays(machine, bricks, 1000);
  std::vector<int> ended(static_cast<std::size_t>(Width * Height), 0);
  const std::uint32_t pixel = 0;
  RunToEnd(rays, Kernel(ended, true), {Width, Height, &pixel, 1}, {});
  RunToEnd(rays, Kernel(ended, true), All, {});
  EXPECT_EQ(ended[0], 2);
  ended[0] = 1;
  EXPECT_EQ(ended, std::vector<int>(ended.size(), 1));
}

/// More rays than the cache has room for are not all begun anew: what one has come past stays.
TEST(WindowedRays, TakeNoLongerThanTheirBricks)
{
  HostMachine machine;
  FewBricks bricks{100, {}, {}, {}};
  Rays rays(machine, bricks, 1000);
  std::vector<int> ended(static_cast<std::size_t>(Width * Height), 0);
  int asked = 0;
  RunToEnd(rays, Kernel(ended, true), All, [&] { return ++asked > 0; });
  EXPECT_EQ(asked, Needed + 1);
  EXPECT_EQ(bricks.clears, 0);
}

TEST(WindowedRays, StopOnRequest)
{
  HostMachine machine;
  FewBricks bricks{100, {}, {}, {}};
  Rays rays(machine, bricks, 50);
  std::vector<int> ended(static_cast<std::size_t>(Width * Height), 0);
  int asked = 0;
  EXPECT_THROW(RunToEnd(rays, Kernel(ended, true), All, [&] { return ++asked < 3; }), inr::Error);
  EXPECT_EQ(asked, 3);
  asked = 0; // of six windows
  EXPECT_THROW(rays.runOnce(Kernel(ended, false), All, [&] { return ++asked < 3; }), inr::Error);
  EXPECT_EQ(asked, 3);
  std::fill(ended.begin(), ended.end(), 0);
  RunToEnd(rays, Kernel(ended, true), All, {});
  EXPECT_EQ(ended, std::vector<int>(ended.size(), 1));
}

} // namespace test::windowed_rays
