// SPDX-License-Identifier: BSD-3-Clause
//
// Bricks that show nothing, and those behind what is opaque: what loading them must not do.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/HiddenScene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace test::hidden_bricks {

constexpr glm::i64vec3 Dims(60, 45, 52);

// What is missing is asked for, even if what stands in for it shows nothing.
TEST(HiddenBricks, AreWaitedForBehindCoarseOnes)
{
  const auto speck = [](const glm::vec3& u) {
    return glm::length(u - glm::vec3(0.31f, 0.62f, 0.55f)) < 0.03f ? 0.7f : 0.1f;
  };
  inr::CacheOptions cache = Options(inr::CachePrecision::Bits16, 9);
  cache.background = false;
  inr::Frame frame = Oblique(glm::dvec3(Dims));
  inr::Renderer renderer = CachedRenderer(Dims, speck, cache);
  renderer.setTransferFunction(Shell(0));
  inr::Image at;
  renderer.render(frame, at);
  inr::Renderer timed = CachedRenderer(Dims, speck, cache, 1);
  timed.setTransferFunction(Shell(0));
  frame.timeLimit = 1e-9;
  inr::Image picture;
  int rounds = 0;
  while (!timed.render(frame, picture).complete && rounds < 2000) {
    ++rounds;
  }
  EXPECT_GT(rounds, 1);
  EXPECT_EQ(picture.pixels, at.pixels);
  EXPECT_GT(*std::max_element(at.pixels.begin(), at.pixels.end()), 0.1f);
}

/// Of pictures in a limited time, one after the other until one is complete.
struct Loading
{
  std::int64_t calls = 0;
  std::int64_t mostAtOnce = 0; ///< bricks in a call
  std::int64_t bricks = 0;
  std::int64_t hidden = 0; ///< samples in the last one
};

Loading LoadAll(const FieldEvaluator::Function& field, const inr::TransferFunction& function,
                const inr::Frame& frame, std::int64_t bytes)
{
  constexpr glm::i64vec3 cube(160, 160, 160);
  inr::RendererOptions options;
  options.threads = 1;
  options.deterministic = true;
  options.cache = Options(inr::CachePrecision::Bits16, 17);
  options.cache.bytes = bytes;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(cube), {}, options);
  renderer.setTransferFunction(function);
  Loading loading;
  inr::FrameStatistics statistics;
  inr::Image picture;
  do {
    statistics = renderer.render(frame, picture);
    ++loading.calls;
    loading.mostAtOnce = std::max(loading.mostAtOnce, statistics.work.bricks.bricks);
    loading.bricks += statistics.work.bricks.bricks;
  } while (!statistics.complete && loading.calls < 5000);
  loading.hidden = statistics.hidden;
  return loading;
}

inr::Frame Limited(double unitDistance)
{
  inr::Frame frame = ParallelFrame(24, {0, 0}, {160, 160}, -10, 300);
  frame.levelOfDetailScale = 0;
  frame.sampleDistance = 0.7;
  frame.unitDistance = unitDistance;
  frame.timeLimit = 0.01;
  return frame;
}

// A ray that has passed a brick has come further, whether there was something to see or not.
TEST(HiddenBricks, AreNotLoadedWithoutEnd)
{
  const auto speck = [](const glm::vec3& u) {
    return glm::length(u - glm::vec3(0.3f, 0.6f, 0.95f)) < 0.03f ? 0.7f : 0.1f;
  };
  constexpr std::int64_t few = 700 << 10;
  const Loading all = LoadAll(speck, Shell(Invisible), Limited(1), few);
  const Loading some = LoadAll(speck, Shell(0), Limited(1), few);
  EXPECT_GT(some.hidden, 0);
  EXPECT_EQ(all.hidden, 0);
  EXPECT_LE(some.mostAtOnce, all.mostAtOnce);
  EXPECT_GT(some.calls, 3);
  EXPECT_LE(some.bricks, all.bricks * 11 / 10);
}

// Behind a wall in front of which nothing is hidden: no more than a batch's samples of old.
TEST(HiddenBricks, AreNotLoadedBehindAWall)
{
  const auto wall = [](const glm::vec3& u) {
    const bool isSpeck = std::sin(40 * u.x) * std::sin(40 * u.y) * std::sin(40 * u.z) > 0.8f;
    return std::abs(u.z - 0.05f) < 0.012f || (u.z > 0.15f && isSpeck) ? 0.7f : 0.1f;
  };
  constexpr std::int64_t enough = 64 << 20;
  const Loading all = LoadAll(wall, Shell(Invisible, 0.999f), Limited(1), enough);
  const Loading some = LoadAll(wall, Shell(0, 0.999f), Limited(1), enough);
  EXPECT_GT(some.hidden, 0);
  EXPECT_LE(some.bricks, all.bricks * 11 / 10);
  EXPECT_LE(some.calls, all.calls * 11 / 10 + 1);
}

} // namespace test::hidden_bricks
