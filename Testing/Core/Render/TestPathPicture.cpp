// SPDX-License-Identifier: BSD-3-Clause
//
// Path tracing through the Renderer: with and without a cache, against what is known.
#include "Core/Error.h"
#include "Testing/Core/Render/PathPictures.h"

#include <atomic>
#include <cmath>
#include <functional>

namespace test::path_picture {

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

} // namespace test::path_picture
