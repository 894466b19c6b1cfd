// SPDX-License-Identifier: BSD-3-Clause
//
// The cached picture against the uncached marcher over the same voxels: what the cache costs must
// be its storage format's error and nothing else.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/FieldCells.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

namespace test::cached {

TEST(Cached, EqualsTheMarcherOverTheDenseVoxels)
{
  CompareWithDense([](const glm::dvec3& dims) { return Oblique(dims); },
                   [](const inr::Image& cached, const inr::Image& dense) {
                     EXPECT_LT(inr::ImageMaximumError(cached, dense), 2e-5f);
                   });
}

TEST(Cached, StorageFormatsCostWhatTheyShould)
{
  const glm::i64vec3 dims(60, 60, 60);
  const inr::Frame frame = Oblique(glm::dvec3(dims));
  const auto picture = [&](inr::CachePrecision precision) {
    inr::Renderer renderer = CachedRenderer(dims, Waves, Options(precision, 16));
    return Render(renderer, frame);
  };
  const inr::Image truth = picture(inr::CachePrecision::Float32);
  EXPECT_GT(inr::ImagePsnr(picture(inr::CachePrecision::Bits16), truth), 105);
  EXPECT_GT(inr::ImagePsnr(picture(inr::CachePrecision::Bits8), truth), 50);
  EXPECT_LT(inr::ImagePsnr(picture(inr::CachePrecision::Bits8), truth), 90);
}

TEST(Cached, ThePictureDoesNotDependOnTheSizeOfTheCacheOrOnThreads)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims));
  frame.levelOfDetailScale = 4; // levels 0 and 1, mixed in between
  frame.height = 300;
  frame.width = 300;
  const auto picture = [&](std::int64_t bytes, int threads) {
    inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 8);
    options.bytes = bytes;
    inr::Renderer renderer = CachedRenderer(dims, Waves, options, threads);
    return Render(renderer, frame).pixels;
  };
  {
    inr::Renderer renderer = CachedRenderer(dims, Waves, Options(inr::CachePrecision::Bits16, 8));
    inr::Image image;
    const inr::LevelSpan levels = renderer.render(frame, image).levels;
    EXPECT_TRUE(levels.finest == 0 && levels.coarsest == 1)
        << levels.finest << " to " << levels.coarsest;
  }
  const std::vector<float> truth = picture(64 << 20, 1);
  EXPECT_EQ(picture(64 << 20, 3), truth);
  EXPECT_EQ(picture(400000, 2), truth);
  EXPECT_EQ(picture(14000, 1), truth); // a dozen bricks of thousands
}

TEST(Cached, FramesInALimitedTimeEndWithTheCompletePicture)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims));
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
  options.background = false;
  inr::Renderer complete = CachedRenderer(dims, Waves, options);
  const inr::Image truth = Render(complete, frame);

  frame.timeLimit = 1e-9; // one batch of bricks for each frame
  inr::Renderer hurried = CachedRenderer(dims, Waves, options);
  inr::Image image;
  inr::FrameStatistics statistics = hurried.render(frame, image);
  EXPECT_FALSE(statistics.complete);
  EXPECT_GT(statistics.missed, 0);
  double psnr = inr::ImagePsnr(image, truth);
  EXPECT_LT(psnr, 60);
  int frames = 1;
  while (!statistics.complete && frames < 1000) {
    statistics = hurried.render(frame, image);
    ++frames;
  }
  EXPECT_GT(frames, 2);
  EXPECT_EQ(statistics.missed, 0);
  EXPECT_EQ(image.pixels, truth.pixels);
}

/// A sample is of one of two levels where these are mixed, whose bricks may not both be there.
TEST(Cached, FramesInALimitedTimeCountWhatMixedLevelsLack)
{
  const glm::i64vec3 dims(97, 83, 91);
  inr::Frame frame = Oblique(glm::dvec3(dims), 130);
  frame.levelOfDetailScale = 1.05;
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 9);
  options.background = false;
  options.maximumRequests = 9;
  inr::Renderer complete = CachedRenderer(dims, Waves, options);
  inr::Image truth;
  const inr::LevelSpan levels = complete.render(frame, truth).levels;
  EXPECT_TRUE(levels.finest == 0 && levels.coarsest == 1)
      << levels.finest << " to " << levels.coarsest;

  frame.timeLimit = 1e-9;
  inr::Renderer hurried = CachedRenderer(dims, Waves, options);
  inr::Image image;
  int frames = 0;
  while (!hurried.render(frame, image).complete && frames < 1000) {
    ++frames;
  }
  EXPECT_GT(frames, 10);
  EXPECT_EQ(image.pixels, truth.pixels);
}

// Of ranges that do not hold, samples are moved into those that there are: whichever level they
// come from, and whatever was there when the other one was not.
TEST(Cached, FramesInALimitedTimeMoveMixedLevelsIntoTheSameRanges)
{
  const glm::i64vec3 dims(60, 56, 52);
  inr::MacroCells cells = CellsOf(Waves, dims, 8);
  for (inr::ValueRange& range : cells.ranges) {
    const float less = 0.2f * (range.high - range.low);
    range = {range.low + less, range.high - less};
  }
  cells.provenance = inr::MacroCellProvenance::File;
  inr::RendererOptions options;
  options.threads = 1;
  options.cache = Options(inr::CachePrecision::Float32, 9);
  options.cache.background = false;
  options.cache.maximumRequests = 3;
  inr::Frame frame = Oblique(glm::dvec3(dims), 60);
  frame.levelOfDetailScale = 1.2;
  inr::Image pictures[2];
  for (const bool inTime : {false, true}) {
    frame.timeLimit = inTime ? 1e-9 : 0.0;
    inr::Renderer renderer(std::make_shared<FieldEvaluator>(Waves), VolumeOf(dims), cells, options);
    renderer.setTransferFunction(Colours());
    int frames = 1;
    while (!renderer.render(frame, pictures[inTime ? 1 : 0]).complete && frames < 1000) {
      ++frames;
    }
    EXPECT_EQ(frames > 10, inTime);
  }
  EXPECT_EQ(pictures[1].pixels, pictures[0].pixels);
}

TEST(Cached, FramesInALimitedTimeEndEvenWhereTheCacheIsTooSmall)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims), 150);
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
  inr::Renderer complete = CachedRenderer(dims, Waves, options);
  const inr::Image truth = Render(complete, frame);

  options.bytes = 200000; // some twenty bricks of more than a hundred
  inr::Renderer hurried = CachedRenderer(dims, Waves, options);
  frame.timeLimit = 0.005;
  inr::Image image;
  inr::FrameStatistics statistics;
  int frames = 0;
  do {
    statistics = hurried.render(frame, image);
    ++frames;
  } while (!statistics.complete && frames < 3000);
  EXPECT_GT(frames, 2);
  EXPECT_TRUE(statistics.complete);
  EXPECT_EQ(image.pixels, truth.pixels);

  frame.clipToWorld[0][0] *= 1.01; // another picture starts anew
  EXPECT_FALSE(hurried.render(frame, image).complete);
}

TEST(Cached, CountsWhatWasDoneBeforeACallWasCancelled)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims), 150);
  frame.timeLimit = 1;
  inr::RendererOptions options;
  options.threads = 1;
  options.deterministic = true; // so much work to a frame
  options.cache = Options(inr::CachePrecision::Bits16, 16);
  options.cache.bytes = 200000; // some twenty bricks of more than a hundred
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(Waves), VolumeOf(dims), {}, options);
  renderer.setTransferFunction(Colours());
  inr::Image image;
  inr::Image taken;
  inr::FrameStatistics statistics;
  int cancelled = 0;
  for (int calls = 0; !statistics.complete || calls == 0; ++calls) {
    ASSERT_LT(calls, 1000);
    int asked = 0;
    try {
      statistics = renderer.render(
          frame, image, nullptr, [&] { return calls % 2 == 0 || ++asked < 4; }, &taken);
    } catch (const inr::Error&) {
      ++cancelled;
    }
  }
  EXPECT_GT(cancelled, 3);
  double sum = 0;
  for (std::size_t k = 0; k < taken.pixels.size(); k += 2) {
    sum += taken.pixels[k];
  }
  EXPECT_EQ(static_cast<double>(statistics.samples), sum);
}

TEST(Cached, FramesInALimitedTimeKnowADepthThatIsNoNumber)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims), 60);
  std::vector<float> depth(static_cast<std::size_t>(frame.width) * frame.height, 1.0f);
  depth[depth.size() / 2] = std::nanf("");
  frame.opaqueDepth = depth.data();
  frame.timeLimit = 1e-9;
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
  options.bytes = 200000;
  inr::Renderer renderer = CachedRenderer(dims, Waves, options);
  inr::Image image;
  int frames = 0;
  while (!renderer.render(frame, image).complete && frames < 3000) {
    ++frames;
  }
  EXPECT_LT(frames, 3000);
}

TEST(Cached, CoarseLevelsStayInRegister)
{
  // A linear ramp is the same at every level; a shift by a fraction of a voxel would show.
  const glm::i64vec3 dims(101, 67, 59);
  const auto ramp = [](const glm::vec3& u) { return u.x; };
  inr::Renderer renderer = CachedRenderer(dims, ramp, Options(inr::CachePrecision::Float32, 8));
  inr::Frame frame = Oblique(glm::dvec3(dims));
  frame.sampleDistance = 0.5;
  const inr::Image fine = Render(renderer, frame);
  frame.levelOfDetailScale = 2;
  const inr::Image coarse = Render(renderer, frame);
  EXPECT_GT(inr::ImagePsnr(coarse, fine), 38);
}

TEST(Cached, ALargerVolumeTakesNoMoreSamples)
{
  // The same view of the same field; levels of detail follow the pixels.
  // All have the same macro-cells, in units of the volume: few voxels of the smallest, many of the
  // largest.
  inr::MacroCells cells = inr::MakeMacroCells(glm::i64vec3(100), 8);
  std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0.0f, 1.0f});
  std::int64_t smallest = 0;
  for (const std::int64_t size : {100, 1600, 25600}) {
    const glm::dvec3 dims(static_cast<double>(size));
    inr::Renderer renderer = FieldRenderer(glm::i64vec3(size), Waves, cells, 2, true);
    renderer.setTransferFunction(Colours());
    inr::Frame frame = Oblique(dims);
    frame.levelOfDetailScale = 1;
    frame.unitDistance = dims.x / 100;
    inr::Image picture;
    const std::int64_t samples = renderer.render(frame, picture).samples;
    smallest = smallest > 0 ? smallest : samples;
    EXPECT_LT(samples, smallest * 1.3) << size;
    EXPECT_GT(samples, smallest * 0.7) << size;
  }
}

TEST(Cached, LogarithmicColoursAreTheSameThroughTheCache)
{
  const glm::i64vec3 dims(30, 30, 30);
  inr::TransferFunction function = Colours();
  function.low = 0.01;
  function.logarithmic = true;
  const Voxels voxels(dims, Waves);
  inr::Renderer dense = FieldRenderer(
      dims, [&](const glm::vec3& u) { return voxels.at(u); }, {}, 2);
  inr::Renderer cached = CachedRenderer(dims, Waves, Options(inr::CachePrecision::Float32, 8));
  dense.setTransferFunction(function);
  cached.setTransferFunction(function);
  const inr::Frame frame = Oblique(glm::dvec3(dims));
  EXPECT_LT(inr::ImageMaximumError(Render(cached, frame), Render(dense, frame)), 2e-4f);
}

TEST(Cached, KeepsItsBudget)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 8);
  options.bytes = 100000;
  inr::Renderer renderer = CachedRenderer(dims, Waves, options);
  Render(renderer, Oblique(glm::dvec3(dims)));
  EXPECT_LE(renderer.cacheBytes(), options.bytes);
  EXPECT_GT(renderer.cachedBricks(), 50);
}

TEST(Cached, CanBeStopped)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Renderer renderer = CachedRenderer(dims, Waves, Options(inr::CachePrecision::Float32, 8));
  inr::Image image;
  std::atomic<int> asked{0};
  const auto keepGoing = [&] { return ++asked < 5; };
  EXPECT_THROW(renderer.render(Oblique(glm::dvec3(dims)), image, nullptr, keepGoing), inr::Error);
}

} // namespace test::cached
