// SPDX-License-Identifier: BSD-3-Clause
//
// The cached picture against the uncached marcher over the same voxels: what the cache costs must
// be its storage format's error and nothing else.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace {

float Waves(const glm::vec3& u)
{
  return 0.5f + 0.5f * std::sin(9.0f * u.x + 4.0f * u.y * u.y) * std::cos(7.0f * u.z - 3.0f * u.x);
}

/// The voxels of a field with trilinear interpolation between them, in double.
class Voxels
{
public:
  Voxels(const glm::i64vec3& dims, const FieldEvaluator::Function& field) : Dims(dims)
  {
    for (std::int64_t z = 0; z < dims.z; ++z) {
      for (std::int64_t y = 0; y < dims.y; ++y) {
        for (std::int64_t x = 0; x < dims.x; ++x) {
          this->Values.push_back(field(glm::vec3((glm::dvec3(x, y, z) + 0.5) / glm::dvec3(dims))));
        }
      }
    }
  }

  float at(const glm::vec3& u) const
  {
    const glm::dvec3 last(this->Dims - std::int64_t{1});
    const glm::dvec3 place =
        glm::clamp(glm::dvec3(u) * glm::dvec3(this->Dims) - 0.5, glm::dvec3(0.0), last);
    const glm::dvec3 cell = glm::floor(place);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 step(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 near = 1.0 - glm::abs(place - cell - step);
      const glm::i64vec3 v(glm::min(cell + step, last));
      sum +=
          near.x * near.y * near.z *
          this->Values[static_cast<std::size_t>(v.x + this->Dims.x * (v.y + this->Dims.y * v.z))];
    }
    return static_cast<float>(sum);
  }

private:
  glm::i64vec3 Dims;
  std::vector<float> Values;
};

inr::TransferFunction Colours()
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    function.table.emplace_back(x, 1 - x, 0.5f, x > 0.5f ? 0.4f * (x - 0.5f) : 0.0f);
  }
  return function;
}

inr::Renderer CachedRenderer(const glm::i64vec3& dims, const FieldEvaluator::Function& field,
                             const inr::CacheOptions& cache, int threads = 2)
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cache = cache;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(dims), {}, options);
  renderer.setTransferFunction(Colours());
  return renderer;
}

inr::Frame Oblique(const glm::dvec3& dims, int size = 48)
{
  inr::Frame frame;
  frame.width = size;
  frame.height = size - 11;
  const glm::dmat4 view =
      glm::lookAt(dims * glm::dvec3(1.9, 1.4, 2.3), 0.5 * dims, glm::dvec3(0.1, 1, 0));
  const double reach = glm::length(dims);
  frame.clipToWorld =
      glm::inverse(glm::perspective(glm::radians(40.0), 48.0 / 37, 0.2 * reach, 5 * reach) * view);
  frame.levelOfDetailScale = 0;
  frame.sampleDistance = 0.7;
  return frame;
}

float LargestDifference(const inr::Image& a, const inr::Image& b)
{
  float largest = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    largest = std::max(largest, std::abs(a.pixels[k] - b.pixels[k]));
  }
  return largest;
}

inr::CacheOptions Options(inr::CachePrecision precision, int brickSize)
{
  inr::CacheOptions options;
  options.precision = precision;
  options.brickSize = brickSize;
  options.bytes = 64 << 20;
  return options;
}

TEST(Cached, EqualsTheMarcherOverTheDenseVoxels)
{
  for (const glm::i64vec3& dims : {glm::i64vec3(33, 46, 21), glm::i64vec3(50, 3, 40),
                                   glm::i64vec3(40, 40, 1), glm::i64vec3(17, 64, 2)}) {
    const Voxels voxels(dims, Waves);
    inr::Renderer dense = FieldRenderer(
        dims, [&](const glm::vec3& u) { return voxels.at(u); }, {}, 2);
    dense.setTransferFunction(Colours());
    const inr::Frame frame = Oblique(glm::dvec3(dims));
    const inr::Image truth = Render(dense, frame);
    for (const int brickSize : {4, 9, 40}) {
      inr::Renderer cached =
          CachedRenderer(dims, Waves, Options(inr::CachePrecision::Float32, brickSize));
      EXPECT_LT(LargestDifference(Render(cached, frame), truth), 2e-5f) << brickSize;
    }
  }
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
  EXPECT_GT(inr::ImagePsnr(picture(inr::CachePrecision::Bits16), truth), 90);
  EXPECT_GT(inr::ImagePsnr(picture(inr::CachePrecision::Bits8), truth), 50);
  EXPECT_LT(inr::ImagePsnr(picture(inr::CachePrecision::Bits8), truth), 90);
}

TEST(Cached, ThePictureDoesNotDependOnTheSizeOfTheCacheOrOnThreads)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims));
  frame.levelOfDetailScale = 1.5; // several levels at once
  frame.height = 300;
  frame.width = 300;
  const auto picture = [&](std::int64_t bytes, int threads) {
    inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 8);
    options.bytes = bytes;
    inr::Renderer renderer = CachedRenderer(dims, Waves, options, threads);
    return Render(renderer, frame).pixels;
  };
  const std::vector<float> truth = picture(64 << 20, 1);
  EXPECT_EQ(picture(64 << 20, 3), truth);
  EXPECT_EQ(picture(400000, 2), truth);
  EXPECT_EQ(picture(14000, 1), truth); // a dozen bricks of thousands
}

TEST(Cached, FramesInALimitedTimeEndWithTheCompletePicture)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Oblique(glm::dvec3(dims));
  const inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
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
  EXPECT_LT(LargestDifference(Render(cached, frame), Render(dense, frame)), 2e-4f);
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

} // namespace
