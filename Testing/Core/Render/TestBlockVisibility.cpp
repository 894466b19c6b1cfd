// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of bricks that show nothing: which those are, and pictures without them.
#include "Core/Random.h"
#include "Core/Render/Bricks/BlockVisibility.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/HiddenScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace test::block_visibility {

constexpr glm::i64vec3 Dims(60, 45, 52);

struct Filled
{
  explicit Filled(inr::CachePrecision precision)
      : levels(Dims, 17), cache(levels, precision, std::int64_t{64} << 20)
  {
    this->values.resize(static_cast<std::size_t>(this->levels.voxelsPerBrick()));
  }

  /// `corner` in the last voxel, and `rest` elsewhere.
  std::int32_t insert(const glm::i64vec3& at, float rest, float corner,
                      const inr::BlockSet& known = inr::BlockSet::all())
  {
    std::fill(this->values.begin(), this->values.end(), rest);
    this->values.back() = corner;
    const inr::BrickKey key = inr::KeyOf({0, at});
    EXPECT_TRUE(this->cache.insert({key, known}, this->values.data()));
    return this->cache.find(key);
  }

  inr::Hierarchy levels;
  inr::BrickCache cache;
  std::vector<float> values;
};

TEST(BlockVisibility, LeavesOutWhatIsNotKnown)
{
  const inr::ColorTable colors(Shell(0), VolumeOf(Dims));
  Filled filled(inr::CachePrecision::Bits16);
  inr::BlockSet known;
  known.add({1, 2, 3});
  const std::int32_t slot = filled.insert({0, 0, 0}, 0.7f, 0.7f, known);
  inr::ShownBlocks shown;
  inr::BlockVisibility(filled.cache, colors).find(slot, shown);
  ASSERT_EQ(shown.kind, inr::ShownBlocks::Kind::Some);
  EXPECT_TRUE(std::equal(known.words.begin(), known.words.end(), shown.words));
}

TEST(BlockVisibility, SaysWhatMayBeSeen)
{
  constexpr float faint = 1e-12f; // is seen, in a great many samples
  const inr::ColorTable colors(Shell(0, faint), VolumeOf(Dims));
  for (const auto precision : {inr::CachePrecision::Float32, inr::CachePrecision::Bits16}) {
    Filled filled(precision);
    const std::int32_t none = filled.insert({0, 0, 0}, 0.1f, 0.3f);
    const std::int32_t all = filled.insert({1, 0, 0}, 0.7f, 0.7f);
    const std::int32_t some = filled.insert({0, 1, 0}, 0.1f, 0.7f);
    const inr::BlockVisibility visibility(filled.cache, colors);
    for (int round = 0; round < 2; ++round) { // found out, and then known
      inr::ShownBlocks shown;
      visibility.find(none, shown);
      EXPECT_EQ(shown.kind, inr::ShownBlocks::Kind::None);
      visibility.find(all, shown);
      EXPECT_EQ(shown.kind, inr::ShownBlocks::Kind::All);
      visibility.find(some, shown);
      ASSERT_EQ(shown.kind, inr::ShownBlocks::Kind::Some);
      for (int z = 0; z < inr::ShownBlocks::Words; ++z) {
        const std::uint64_t last = std::uint64_t{1} << (3 + 8 * 3); // the brick's far corner
        EXPECT_EQ(shown.words[z], z == 3 ? last : 0) << z;
      }
    }
  }
}

TEST(BlockVisibility, NoticesThatABrickIsAnother)
{
  const inr::ColorTable colors(Shell(0), VolumeOf(Dims));
  const inr::Hierarchy levels(Dims, 17);
  inr::BrickCache cache(levels, inr::CachePrecision::Bits16, 200 << 10); // a few
  const inr::BlockVisibility visibility(cache, colors);
  std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()));
  std::uint64_t frame = 1;
  int changes = 0;
  for (std::int64_t k = 0; k < 60; ++k) {
    cache.beginFrame(++frame);
    const bool isSeen = inr::RandomUnit(5, static_cast<std::uint64_t>(k)) > 0.5f;
    std::fill(values.begin(), values.end(), isSeen ? 0.7f : 0.2f);
    const inr::BrickKey key = inr::KeyOf({0, {k % 4, k / 4 % 3, k / 12 % 4}});
    if (cache.find(key) >= 0) {
      continue;
    }
    if (cache.mapped() == cache.capacity() && k % 3 == 0) {
      cache.evict(frame); // which moves another one into its slot
    }
    ASSERT_TRUE(cache.insert(key, values.data()));
    inr::ShownBlocks shown;
    visibility.find(cache.find(key), shown);
    EXPECT_EQ(shown.kind, isSeen ? inr::ShownBlocks::Kind::All : inr::ShownBlocks::Kind::None);
    for (std::int32_t slot = 0; slot < cache.mapped(); ++slot) {
      visibility.find(slot, shown);
      const bool isOpaque = static_cast<const std::uint16_t*>(cache.view(slot).voxels)[0] == 0 &&
                            cache.view(slot).low > 0.5f;
      EXPECT_EQ(shown.kind, isOpaque ? inr::ShownBlocks::Kind::All : inr::ShownBlocks::Kind::None);
    }
    ++changes;
  }
  EXPECT_GT(changes, 40);
  EXPECT_GT(cache.capacity(), 8);
}

struct Way
{
  std::string name;
  std::function<void(inr::Frame&, inr::CacheOptions&)> set;
};

const Way Ways[] = {
    {"as it is", [](inr::Frame&, inr::CacheOptions&) {}},
    {"levels mixed", [](inr::Frame& frame, inr::CacheOptions&) { frame.levelOfDetailScale = 3; }},
    {"shaded",
     [](inr::Frame& frame, inr::CacheOptions&) {
       frame.shading.emplace();
       frame.lights.emplace_back();
       frame.levelOfDetailScale = 1.5;
     }},
    {"shaded, with a small cache",
     [](inr::Frame& frame, inr::CacheOptions& cache) {
       frame.shading.emplace();
       frame.lights.emplace_back();
       cache.bytes = cache.bytes / 200;
     }},
    {"a small cache",
     [](inr::Frame&, inr::CacheOptions& cache) { cache.bytes = cache.bytes / 400; }},
    {"eight bits, joined",
     [](inr::Frame& frame, inr::CacheOptions& cache) {
       cache.precision = inr::CachePrecision::Bits8;
       frame.adaptiveSampling = true;
       frame.sampleDistance = 0.1;
       frame.unitDistance = 1e4; // faint enough for that
     }},
    {"far apart", [](inr::Frame& frame, inr::CacheOptions&) { frame.sampleDistance = 6; }},
    {"pre-integrated", [](inr::Frame& frame, inr::CacheOptions&) { frame.preIntegration = true; }},
    {"pre-integrated and shaded, levels mixed, with a small cache",
     [](inr::Frame& frame, inr::CacheOptions& cache) {
       frame.preIntegration = true;
       frame.shading.emplace();
       frame.lights.emplace_back();
       frame.levelOfDetailScale = 1.5;
       cache.bytes = cache.bytes / 200;
     }},
    {"large bricks",
     [](inr::Frame& frame, inr::CacheOptions& cache) {
       cache.brickSize = 50;
       frame.sampleDistance = 0.03;
     }},
    {"a piece",
     [](inr::Frame& frame, inr::CacheOptions&) {
       frame.piece = {{0.3, 0.2, 1, -35}, {-0.3, -0.2, -1, 55}};
     }},
    {"of a translucent surface",
     [](inr::Frame& frame, inr::CacheOptions&) { AddLayerHalfWay(frame); }},
};

/// Between one value and the other only where coarse voxels are half of this and half of that: a
/// coarse level shows what the finer one does not.
float Edges(const glm::vec3& u) { return Waves(u) > 0.5f ? 1.0f : 0.3f; }

// What is left out adds nothing.
TEST(BlockVisibility, LeavesPicturesAsTheyAre)
{
  for (std::size_t k = 0; k < 2 * std::size(Ways); ++k) {
    const Way& way = Ways[k / 2];
    const auto& field = k % 2 == 0 ? Waves : Edges;
    SCOPED_TRACE(way.name + (k % 2 == 0 ? ", waves" : ", edges"));
    inr::Frame frame = Oblique(glm::dvec3(Dims));
    frame.adaptiveSampling = false;
    inr::CacheOptions cache = Options(inr::CachePrecision::Bits16, 17);
    way.set(frame, cache);
    std::int64_t samples[2];
    inr::Image pictures[2];
    inr::Image depths[2];
    for (const int all : {0, 1}) {
      inr::Renderer renderer = CachedRenderer(Dims, field, cache);
      renderer.setTransferFunction(Shell(all != 0 ? Invisible : 0));
      samples[all] = renderer.render(frame, pictures[all], &depths[all]).samples;
    }
    ExpectSame(pictures[0], pictures[1]);
    ExpectSame(depths[0], depths[1]);
    EXPECT_LT(samples[0], samples[1]);
    EXPECT_GT(*std::max_element(pictures[0].pixels.begin(), pictures[0].pixels.end()), 1e-4f);
  }
}

// Nor are blocks left out that lie between two samples.
TEST(BlockVisibility, LeavesOutNoBlockThatColoursAreIntegratedThrough)
{
  for (const int brickSize : {8, 17, 40}) {
    for (const double distance : {2.5, 3.6, 9.0}) {
      SCOPED_TRACE(testing::Message() << brickSize << " " << distance);
      inr::Frame frame = Oblique(glm::dvec3(Dims));
      frame.preIntegration = true;
      frame.sampleDistance = distance;
      inr::Image pictures[2];
      for (const int all : {0, 1}) {
        inr::Renderer renderer =
            CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Bits16, brickSize));
        renderer.setTransferFunction(Shell(all != 0 ? Invisible : 0));
        renderer.render(frame, pictures[all]);
      }
      ExpectSame(pictures[0], pictures[1]);
    }
  }
}

// Samples are left out where none of the voxels around them can be seen, and nowhere else than in
// a block's reach of that.
TEST(BlockVisibility, TakesTheSamplesOfBlocksThatAreSeen)
{
  const auto field = [](const glm::vec3& u) { return u.z > 0.5f ? 0.7f : 0.1f; };
  inr::CacheOptions cache = Options(inr::CachePrecision::Bits16, 17);
  inr::Renderer renderer = CachedRenderer({65, 65, 65}, field, cache);
  renderer.setTransferFunction(Shell(0));
  // Along +z, one sample a voxel; opaque so that none ends early.
  inr::Frame frame = ParallelFrame(8, {0, 0}, {64, 64}, -10, 100);
  frame.levelOfDetailScale = 0;
  frame.sampleDistance = 1;
  frame.unitDistance = 1e6;
  frame.adaptiveSampling = false;
  inr::Image picture;
  // From the block of voxels 28 to 32, the last of which is seen, to voxel 64.
  const double perRay = static_cast<double>(renderer.render(frame, picture).samples) / 64;
  EXPECT_GE(perRay, 64 - 32);
  EXPECT_LE(perRay, 64 - 28 + 1);
}

TEST(BlockVisibility, FollowsTheColours)
{
  const inr::Frame frame = Oblique(glm::dvec3(Dims));
  const inr::CacheOptions cache = Options(inr::CachePrecision::Bits16, 17);
  inr::Renderer renderer = CachedRenderer(Dims, Waves, cache);
  renderer.setTransferFunction(Shell(0));
  Render(renderer, frame);
  renderer.setTransferFunction(OpacityRamp(0.2f));
  inr::Renderer fresh = CachedRenderer(Dims, Waves, cache);
  fresh.setTransferFunction(OpacityRamp(0.2f));
  EXPECT_EQ(Render(renderer, frame).pixels, Render(fresh, frame).pixels);
}

// Each sample is taken or counted as left out, once, where no ray ends early.
TEST(BlockVisibility, CountsWhatIsLeftOut)
{
  for (const Way& way : Ways) {
    SCOPED_TRACE(way.name);
    inr::Frame frame = Oblique(glm::dvec3(Dims));
    frame.adaptiveSampling = false;
    inr::CacheOptions cache = Options(inr::CachePrecision::Bits16, 17);
    way.set(frame, cache);
    frame.unitDistance = 1e7;
    inr::FrameStatistics statistics[2];
    for (const int all : {0, 1}) {
      inr::Renderer renderer = CachedRenderer(Dims, Waves, cache);
      renderer.setTransferFunction(Shell(all != 0 ? Invisible : 0));
      inr::Image picture;
      statistics[all] = renderer.render(frame, picture);
    }
    EXPECT_GT(statistics[0].hidden, 0);
    EXPECT_EQ(statistics[1].hidden, 0);
    EXPECT_EQ(statistics[0].samples + statistics[0].hidden, statistics[1].samples);
    EXPECT_EQ(statistics[0].hitRate(), 1.0);
  }
}

} // namespace test::block_visibility
