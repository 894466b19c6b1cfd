// SPDX-License-Identifier: BSD-3-Clause
//
// Path tracing through the Renderer: with and without a cache, in parts, against what is known.
#include "Core/Error.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Scene/PerView.h"
#include "Testing/Core/Render/PathScene.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <set>
#include <thread>

namespace test::path_picture {

const glm::i64vec3 Dims(33, 33, 33);

/// Linear along every axis, so that interpolation between voxels has no error.
float Multilinear(const glm::vec3& u)
{
  return 0.1f + 0.8f * u.x * u.y + 0.1f * u.z - 0.3f * u.x * u.y * u.z;
}

inr::TransferFunction Medium()
{
  inr::TransferFunction medium;
  medium.table = {{1, 0.2f, 0, 0}, {0.3f, 1, 0, 0.05f}, {0.1f, 0.5f, 1, 0.3f}};
  return medium;
}

inr::CacheOptions SmallBricks()
{
  inr::CacheOptions cache;
  cache.precision = inr::CachePrecision::Float32;
  cache.brickSize = 8;
  cache.bytes = 64 << 20;
  cache.background = false; // every call brings something
  return cache;
}

inr::Renderer MakeRenderer(bool cached, int threads = 2,
                           const inr::CacheOptions& cache = SmallBricks())
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cached = cached;
  options.cache = cache;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(Multilinear), VolumeOf(Dims), {},
                         options);
  renderer.setTransferFunction(Medium());
  return renderer;
}

/// Everything at once: oblique, ambient light and a lamp, some rays past the volume.
inr::Frame LitFrame(int size = 24)
{
  inr::Frame frame = ParallelFrame(size, {-4, -4}, {36, 36}, -30, 80);
  frame.clipToWorld = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0, 1, 0.2)) * frame.clipToWorld;
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 4;
  frame.levelOfDetailScale = 0;
  frame.paths.ambientLight = {0.2f, 0.3f, 0.4f};
  frame.paths.anisotropy = 0.3;
  frame.lights = {inr::Light{}};
  frame.lights[0].color = {2, 1, 1};
  return frame;
}

/// Per pixel and channel: mean of many frames of one path each, and its squared standard error.
struct Samples
{
  Samples(inr::Renderer& renderer, inr::Frame frame, int frames, std::uint64_t firstFrame = 0)
  {
    frame.samplesPerPixel = 1;
    for (int k = 0; k < frames; ++k) {
      frame.frameIndex = firstFrame + static_cast<std::uint64_t>(k);
      const inr::Image image = Render(renderer, frame);
      this->mean.resize(image.pixels.size());
      this->variance.resize(image.pixels.size());
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto value = static_cast<double>(image.pixels[i]);
        this->mean[i] += value / frames;
        this->variance[i] += value * value / frames;
      }
    }
    for (std::size_t i = 0; i < this->mean.size(); ++i) {
      this->variance[i] = (this->variance[i] - this->mean[i] * this->mean[i]) / frames;
    }
  }

  /// Of the whole picture's sum in one channel.
  Estimate total(std::size_t channel) const
  {
    Estimate sum{0, 0};
    for (std::size_t i = channel; i < this->mean.size(); i += 4) {
      sum.mean += this->mean[i];
      sum.error += this->variance[i];
    }
    return {sum.mean, std::sqrt(sum.error)};
  }

  std::vector<double> mean;
  std::vector<double> variance;
};

/// Two independent estimates of the same picture, pixel by pixel and as a whole.
void ExpectSame(const Samples& a, const Samples& b)
{
  for (std::size_t i = 0; i < a.mean.size(); ++i) {
    const double error = std::sqrt(a.variance[i] + b.variance[i]);
    // A pixel that no path of the one met can have been met by very few of the other.
    EXPECT_LT(std::abs(a.mean[i] - b.mean[i]), 6.0 * error + 0.05) << i;
  }
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const Estimate first = a.total(channel);
    const Estimate second = b.total(channel);
    const double error = std::hypot(first.error, second.error);
    EXPECT_LT(std::abs(first.mean - second.mean), Unlikely * error) << channel;
    EXPECT_LT(error, 0.01 * first.mean); // so that a mistake would show
  }
}

TEST(PathPicture, IsAWhiteFurnaceWithAndWithoutACache)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = MakeRenderer(cached);
    renderer.setTransferFunction(OpacityRamp(0.5f));
    inr::Frame frame = LitFrame();
    frame.lights.clear();
    frame.paths.maximumBounces = 1 << 30;
    frame.paths.ambientLight = {0.75f, 0.5f, 0.25f};
    const inr::Image image = Render(renderer, frame);
    float most = 0;
    for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
      const float alpha = image.pixels[k + 3];
      EXPECT_EQ(image.pixels[k], 0.75f * alpha);
      EXPECT_EQ(image.pixels[k + 1], 0.5f * alpha);
      EXPECT_EQ(image.pixels[k + 2], 0.25f * alpha);
      most = std::max(most, alpha);
    }
    EXPECT_EQ(most, 1.0f);
  }
}

TEST(PathPicture, CacheAndNetworkAgree)
{
  inr::Renderer cached = MakeRenderer(true);
  inr::Renderer network = MakeRenderer(false);
  const inr::Frame frame = LitFrame();
  ExpectSame(Samples(cached, frame, 500), Samples(network, frame, 500, 500));
}

TEST(PathPicture, CacheAndNetworkAgreeWhereTheCacheIsTooSmall)
{
  inr::CacheOptions options = SmallBricks();
  options.bytes = 60000; // some twenty of more than a hundred bricks
  inr::Renderer cached = MakeRenderer(true, 2, options);
  inr::Renderer network = MakeRenderer(false);
  const inr::Frame frame = LitFrame();
  ExpectSame(Samples(cached, frame, 500), Samples(network, frame, 500, 500));
  EXPECT_LE(cached.cacheBytes(), options.bytes);
}

TEST(PathPicture, EmissionAndAbsorptionMakeTheMarchersPicture)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = MakeRenderer(cached);
    inr::Frame frame = LitFrame(16);
    frame.paths.emissionOnly = true;
    const Samples traced(renderer, frame, 1000);
    frame.mode = inr::RenderMode::RayMarching;
    frame.sampleDistance = 0.05;
    const inr::Image marched = Render(renderer, frame);
    double chiSquare = 0;
    for (std::size_t i = 0; i < traced.mean.size(); ++i) {
      // The marcher stops at 99.9 % opacity and its steps have an error of their own.
      constexpr double march = 2e-3;
      const double difference = traced.mean[i] - marched.pixels[i];
      EXPECT_LT(std::abs(difference), 6.0 * std::sqrt(traced.variance[i]) + march) << i;
      chiSquare += difference * difference / (traced.variance[i] + march * march);
    }
    // Four channels of a pixel go together: 256 independent ones.
    EXPECT_LT(chiSquare, 1024.0 + Unlikely * std::sqrt(32.0 * 256));
  }
}

TEST(PathPicture, DoesNotDependOnThreadsTheCacheOrEarlierPictures)
{
  inr::Frame frame = LitFrame(40);
  frame.levelOfDetailScale = 2; // several levels at once
  inr::Renderer one = MakeRenderer(true, 1);
  const std::vector<float> truth = Render(one, frame).pixels;
  inr::CacheOptions options = SmallBricks();
  inr::Renderer three = MakeRenderer(true, 3, options);
  EXPECT_EQ(Render(three, frame).pixels, truth);
  options.bytes = 4 << 20;
  options.ranking = false;
  inr::Renderer unranked = MakeRenderer(true, 2, options);
  inr::Frame other = frame;
  other.seed = 7;
  EXPECT_NE(Render(unranked, other).pixels, truth);
  EXPECT_EQ(Render(unranked, frame).pixels, truth);
  other = frame;
  other.frameIndex = 1;
  EXPECT_NE(Render(unranked, other).pixels, truth);
}

TEST(PathPicture, IsTheSameAfterOneThatDidNotFitTheCache)
{
  inr::CacheOptions options = SmallBricks();
  options.bytes = 60000;
  inr::Renderer small = MakeRenderer(true, 2, options);
  inr::Frame frame = LitFrame();
  Render(small, frame);
  EXPECT_EQ(Render(small, frame).pixels, Render(small, frame).pixels);
  frame.clippingPlanes = {{0, 0, -1, 6}, {-1, 0, 0, 12}}; // a dozen bricks
  inr::Renderer large = MakeRenderer(true);
  EXPECT_EQ(Render(small, frame).pixels, Render(large, frame).pixels);
}

/// Calls with next to no time until the picture is complete; how many.
int RenderInParts(inr::Renderer& renderer, inr::Frame frame, inr::Image& image)
{
  frame.timeLimit = 1e-9;
  std::int64_t paths = 0;
  for (int call = 1; call < 1000; ++call) {
    const inr::FrameStatistics statistics = renderer.render(frame, image);
    EXPECT_GE(statistics.paths, paths);
    EXPECT_LE(statistics.paths, paths + 1);
    EXPECT_EQ(statistics.complete, statistics.paths == frame.samplesPerPixel);
    paths = statistics.paths;
    if (statistics.complete) {
      return call;
    }
  }
  return 1000;
}

TEST(PathPicture, PartsMakeTheSamePicture)
{
  const inr::Frame frame = LitFrame();
  for (const bool cached : {false, true}) {
    inr::Renderer whole = MakeRenderer(cached);
    inr::Renderer parts = MakeRenderer(cached);
    inr::Image image;
    const int calls = RenderInParts(parts, frame, image);
    EXPECT_GE(calls, frame.samplesPerPixel);
    EXPECT_LT(calls, 300);
    EXPECT_EQ(image.pixels, Render(whole, frame).pixels);
  }
}

TEST(PathPicture, PartsMakeTheSamePictureWhileBricksLoadBehindIt)
{
  inr::CacheOptions options = SmallBricks();
  options.background = true;
  inr::Renderer parts = MakeRenderer(true, 2, options);
  inr::Frame frame = LitFrame();
  inr::Renderer whole = MakeRenderer(true);
  const inr::Image truth = Render(whole, frame);
  frame.timeLimit = 0.01;
  inr::Image image;
  int calls = 1;
  while (!parts.render(frame, image).complete && calls < 10000) {
    ++calls;
  }
  EXPECT_LT(calls, 10000);
  EXPECT_EQ(image.pixels, truth.pixels);
}

TEST(PathPicture, ShowsWhatThereIsBeforeTheFirstCompleteSample)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame();
  frame.timeLimit = 1e-9;
  inr::Image image;
  const inr::FrameStatistics statistics = renderer.render(frame, image);
  EXPECT_EQ(statistics.paths, 0);
  EXPECT_FALSE(statistics.complete);
  EXPECT_GT(statistics.missed, 0);
  EXPECT_LE(statistics.missed, statistics.samples);
  EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.0f);
}

TEST(PathPicture, EndsInPartsEvenWhereTheCacheIsTooSmall)
{
  inr::CacheOptions options = SmallBricks();
  options.bytes = 60000;
  inr::Renderer renderer = MakeRenderer(true, 2, options);
  inr::Image image;
  EXPECT_LT(RenderInParts(renderer, LitFrame(), image), 300);
}

TEST(PathPicture, InfersNoMoreTilesThanThereIsTimeFor)
{
  inr::CacheOptions options = SmallBricks();
  options.bytes = 60000;
  inr::Renderer renderer = MakeRenderer(true, 2, options);
  const inr::Frame frame = LitFrame(64); // 16 tiles, more than between two looks at the time
  inr::Image image;
  const int calls = RenderInParts(renderer, frame, image);
  EXPECT_GE(calls, 2 * frame.samplesPerPixel);
  EXPECT_LT(calls, 300);
}

TEST(PathPicture, GoesOnOnlyWithTheSamePicture)
{
  const std::vector<float> depth(24 * 24, 0.5f);
  const std::vector<std::function<void(inr::Frame&)>> changes = {
      [](inr::Frame& frame) { frame.clipToWorld[3].x += 0.1; },
      [](inr::Frame& frame) { frame.paths.maximumBounces = 3; },
      [](inr::Frame& frame) { frame.paths.scatteringAlbedo = 0.5f; },
      [](inr::Frame& frame) { frame.paths.anisotropy = 0; },
      [](inr::Frame& frame) { frame.paths.ambientLight.x = 1; },
      [](inr::Frame& frame) { frame.paths.emissionOnly = true; },
      [](inr::Frame& frame) { frame.lights[0].direction.x = 1; },
      [](inr::Frame& frame) { frame.lights.clear(); },
      [&](inr::Frame& frame) { frame.opaqueDepth = depth.data(); },
      [](inr::Frame& frame) { frame.seed = 1; },
      [](inr::Frame& frame) { frame.samplesPerPixel = 2; }};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    inr::Renderer renderer = MakeRenderer(false);
    inr::Frame frame = LitFrame();
    Render(renderer, frame);
    changes[k](frame);
    inr::Renderer fresh = MakeRenderer(false);
    EXPECT_EQ(Render(renderer, frame).pixels, Render(fresh, frame).pixels) << k;
  }
}

/// Calls for one view after the other until all pictures are complete; how many for each of them.
int RenderByTurns(inr::Renderer& renderer, std::vector<inr::Frame> frames,
                  std::vector<inr::Image>& images)
{
  images.resize(frames.size());
  for (int calls = 1; calls < 300; ++calls) {
    bool complete = true;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      frames[k].timeLimit = 1e-9;
      frames[k].view = static_cast<int>(k);
      complete = renderer.render(frames[k], images[k]).complete && complete;
    }
    if (complete) {
      return calls;
    }
  }
  return 300;
}

/// As many pictures from different sides.
std::vector<inr::Frame> Sides(std::size_t count)
{
  std::vector<inr::Frame> frames(count, LitFrame());
  for (std::size_t k = 0; k < count; ++k) {
    frames[k].clipToWorld[3].x += 0.1 * static_cast<double>(k);
  }
  return frames;
}

TEST(PathPicture, GoesOnForEachViewByTurns)
{
  const std::vector<inr::Frame> frames = Sides(inr::PerView<inr::PathPicture>::Most);
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = MakeRenderer(cached);
    std::vector<inr::Image> images;
    EXPECT_LT(RenderByTurns(renderer, frames, images), 100);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      inr::Renderer alone = MakeRenderer(cached);
      EXPECT_EQ(images[k].pixels, Render(alone, frames[k]).pixels) << k;
    }
  }
}

/// As what a selection looks at.
TEST(PathPicture, GoesOnWhenRaysWereMarchedForAnotherView)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame();
  frame.samplesPerPixel = 1000;
  frame.timeLimit = 1e-9;
  inr::Image image;
  std::int64_t paths = 0;
  while (paths < 2) {
    paths = renderer.render(frame, image).paths;
  }
  inr::Frame rays = frame;
  rays.mode = inr::RenderMode::RayMarching;
  rays.view = -1;
  inr::Image other;
  renderer.render(rays, other);
  EXPECT_GE(renderer.render(frame, image).paths, paths);
}

TEST(PerView, KeepsThoseOfTheViewsThatWereDrawnLast)
{
  inr::PerView<inr::PathPicture> pictures;
  const int most = inr::PerView<inr::PathPicture>::Most;
  std::vector<const inr::PathPicture*> first;
  for (int view = 0; view < most; ++view) {
    first.push_back(&pictures.of(view));
  }
  EXPECT_EQ(std::set<const inr::PathPicture*>(first.begin(), first.end()).size(), first.size());
  EXPECT_EQ(&pictures.of(0), first[0]);
  pictures.of(most); // in place of 1
  for (int view = 2; view < most; ++view) {
    EXPECT_EQ(&pictures.of(view), first[static_cast<std::size_t>(view)]);
  }
  EXPECT_EQ(&pictures.of(0), first[0]);
}

TEST(PathPicture, StartsAnewWithAnotherTransferFunction)
{
  inr::Renderer renderer = MakeRenderer(true);
  const inr::Frame frame = LitFrame();
  Render(renderer, frame);
  renderer.setTransferFunction(OpacityRamp(0.1f));
  inr::Renderer fresh = MakeRenderer(true);
  fresh.setTransferFunction(OpacityRamp(0.1f));
  EXPECT_EQ(Render(renderer, frame).pixels, Render(fresh, frame).pixels);
}

TEST(PathPicture, MoreSamplesGoOnWhereFewerEnded)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame();
  inr::Image image;
  EXPECT_EQ(renderer.render(frame, image).paths, 4);
  EXPECT_EQ(Render(renderer, frame).pixels, image.pixels);
  frame.samplesPerPixel = 9;
  std::atomic<int> asked{0};
  const auto count = [&] { return ++asked > 0; };
  EXPECT_EQ(renderer.render(frame, image, nullptr, count).paths, 9);
  const std::vector<float> whole = image.pixels;
  const int some = asked.exchange(0); // for five more samples
  inr::Renderer fresh = MakeRenderer(true);
  EXPECT_EQ(fresh.render(frame, image, nullptr, count).paths, 9);
  EXPECT_EQ(whole, image.pixels);
  EXPECT_LT(some, 0.8 * asked);
}

TEST(PathPicture, LosesNothingWhenItIsStopped)
{
  inr::Renderer renderer = MakeRenderer(true);
  const inr::Frame frame = LitFrame();
  inr::Image image;
  for (const int patience : {1, 3, 6, 11}) {
    std::atomic<int> asked{0};
    const auto keepGoing = [&] { return ++asked < patience; };
    EXPECT_THROW(renderer.render(frame, image, nullptr, keepGoing), inr::Error);
  }
  inr::Renderer fresh = MakeRenderer(true);
  EXPECT_EQ(Render(renderer, frame).pixels, Render(fresh, frame).pixels);
}

TEST(PathPicture, DepthIsThatOfTheFirstCollisions)
{
  inr::Renderer renderer = MakeRenderer(true);
  renderer.setTransferFunction(UniformMedium(0.1f));
  inr::Frame frame = ParallelFrame(32, {4, 4}, {28, 28}, -10, 50);
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 100;
  inr::Image image;
  inr::Image depth;
  renderer.render(frame, image, &depth);
  const double density = -std::log(0.9);
  const double all = std::exp(-density * 32);
  const double way = 1 / density - 32 * all / (1 - all); // mean of those within 32
  double sum = 0;
  for (const float z : depth.pixels) {
    sum += z;
  }
  EXPECT_NEAR(sum / static_cast<double>(depth.pixels.size()), (way + 10) / 60, 0.002);
  renderer.setTransferFunction(UniformMedium(0.001f));
  renderer.render(frame, image, &depth);
  EXPECT_EQ(depth.pixels, std::vector<float>(32 * 32, 1.0f));
}

TEST(PathPicture, RefusesWhatIsOutOfRange)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Image image;
  inr::Frame frame = LitFrame();
  frame.samplesPerPixel = 0;
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
  frame = LitFrame();
  frame.paths.anisotropy = 1;
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
  frame = LitFrame();
  frame.lights[0].direction = glm::dvec3(0);
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
}

// A round whose tiles take far longer than there is time for: here, as each look at the field
// waits.
TEST(PathPicture, EndsInTheMidstOfARoundThatTakesFarTooLong)
{
  inr::Frame frame = LitFrame(96);
  frame.samplesPerPixel = 1;
  frame.timeLimit = 1e-3;
  inr::Renderer renderer = MakeRenderer(true);
  const inr::Image whole = Render(renderer, [&] {
    inr::Frame unlimited = frame;
    unlimited.timeLimit = 0;
    return unlimited;
  }());
  frame.view = 1;
  const auto slowly = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return true;
  };
  const auto holes = [](const inr::Image& image) {
    std::size_t count = 0;
    for (std::size_t k = 3; k < image.pixels.size(); k += 4) {
      count += image.pixels[k] == 0 ? 1 : 0;
    }
    return count;
  };
  inr::Image image;
  const inr::FrameStatistics first = renderer.render(frame, image, nullptr, slowly);
  EXPECT_FALSE(first.complete);
  EXPECT_EQ(first.paths, 0);
  EXPECT_GT(first.marchSeconds, 0.25); // for all, by those that were reached
  EXPECT_GT(holes(image), holes(whole));
  EXPECT_LT(holes(image), whole.pixels.size() / 4);
  int frames = 1;
  while (!renderer.render(frame, image, nullptr, slowly).complete) {
    ASSERT_LT(++frames, 100);
  }
  EXPECT_EQ(image.pixels, whole.pixels);
}

} // namespace test::path_picture
