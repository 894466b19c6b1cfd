// SPDX-License-Identifier: BSD-3-Clause
//
// Blend modes that project values, through the cache and straight from the field, against fine sums
// along the rays in double.
#include "Core/Error.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/BlendScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::projections {

using inr::BlendMode;

constexpr BlendMode Modes[] = {BlendMode::MaximumIntensity, BlendMode::MinimumIntensity,
                               BlendMode::AverageIntensity, BlendMode::Additive};

/// What the values along a ray come to, by a sum of many.
struct Sums
{
  double least = 2;
  double most = -1;
  double opaque = 0; ///< value times opacity
  double averaged = 0;
  double length = 0; ///< of what is averaged
};

Sums Along(const inr::Ray& ray, const BlendScene& scene, const inr::Blending& blending)
{
  constexpr int pieces = 3000;
  const double piece = ray.length / pieces;
  Sums sums;
  for (int k = 0; k < pieces; ++k) {
    const double value = scene.at(ray.at((k + 0.5) * piece));
    const double data = BlendScene::Low + (BlendScene::High - BlendScene::Low) * value;
    const double opaque = scene.colorOf(value).w * value * piece;
    sums.least = std::min(sums.least, value);
    sums.most = std::max(sums.most, value);
    sums.opaque += opaque;
    if (data >= blending.averageLow && data <= blending.averageHigh) {
      sums.averaged += opaque;
      sums.length += piece;
    }
  }
  return sums;
}

glm::dvec4 Grey(double value) { return {glm::dvec3(std::clamp(value, 0.0, 1.0)), 1.0}; }

glm::dvec4 Truth(const inr::Ray& ray, const BlendScene& scene, const inr::Frame& frame)
{
  if (!(ray.length > 0)) {
    return glm::dvec4(0.0);
  }
  const Sums sums = Along(ray, scene, frame.blending);
  switch (frame.blending.mode) {
  case BlendMode::AverageIntensity:
    return sums.length > 0 ? Grey(sums.averaged / sums.length) : glm::dvec4(0.0);
  case BlendMode::Additive:
    return Grey(sums.opaque / frame.unitDistance);
  default:
    const bool most = frame.blending.mode == BlendMode::MaximumIntensity;
    const glm::dvec4 color = scene.colorOf(most ? sums.most : sums.least);
    return {glm::dvec3(color) * color.w, color.w};
  }
}

inr::Frame FrameOf(const BlendScene& scene, BlendMode mode)
{
  inr::Frame frame = Oblique(glm::dvec3(scene.dims), 26);
  frame.blending.mode = mode;
  frame.unitDistance = 40;
  return frame;
}

void ExpectTruth(const inr::Image& image, const BlendScene& scene, const inr::Frame& frame,
                 double tolerance)
{
  const inr::RayGeometry geometry(frame, scene.dims);
  double largest = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const glm::dvec4 truth = Truth(geometry.ray(x, y), scene, frame);
      for (int channel = 0; channel < 4; ++channel) {
        largest = std::max(largest, std::abs(image.pixel(x, y)[channel] - truth[channel]));
      }
    }
  }
  EXPECT_LT(largest, tolerance);
}

class Projections : public testing::TestWithParam<bool>
{
protected:
  BlendScene scene;

  inr::Renderer renderer(bool ranges = true) const
  {
    return this->scene.renderer(this->GetParam(), ranges);
  }
};

INSTANTIATE_TEST_SUITE_P(, Projections, testing::Bool(), [](const auto& cached) {
  return cached.param ? std::string("Cached") : std::string("Uncached");
});

TEST_P(Projections, AreThoseOfTheField)
{
  inr::Renderer renderer = this->renderer();
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = FrameOf(this->scene, mode);
    frame.sampleDistance = 0.05;
    ExpectTruth(Render(renderer, frame), this->scene, frame, 4e-3);
  }
}

TEST_P(Projections, DoNotDependOnTheSampleDistanceBeyondItsError)
{
  inr::Renderer renderer = this->renderer();
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = FrameOf(this->scene, mode);
    frame.sampleDistance = 0.5;
    ExpectTruth(Render(renderer, frame), this->scene, frame, 0.05);
  }
}

TEST_P(Projections, AverageOnlyTheValuesAskedFor)
{
  inr::Renderer renderer = this->renderer();
  inr::Frame frame = FrameOf(this->scene, BlendMode::AverageIntensity);
  frame.sampleDistance = 0.05;
  frame.blending.averageLow = BlendScene::Low + 0.3 * (BlendScene::High - BlendScene::Low);
  frame.blending.averageHigh = BlendScene::Low + 0.6 * (BlendScene::High - BlendScene::Low);
  const inr::Image some = Render(renderer, frame);
  ExpectTruth(some, this->scene, frame, 0.02); // a sample more or less of few
  frame.blending.averageLow = frame.blending.averageHigh = 2 * BlendScene::High;
  for (const float component : Render(renderer, frame).pixels) {
    ASSERT_EQ(component, 0.0f); // no values, no picture
  }
}

TEST_P(Projections, SkipWhatAddsNothingAndShowTheSame)
{
  inr::Renderer with = this->renderer();
  inr::Renderer without = this->renderer(false);
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = FrameOf(this->scene, mode);
    frame.sampleDistance = 0.3;
    if (mode == BlendMode::AverageIntensity) {
      frame.blending.averageLow = BlendScene::Low + 0.52 * (BlendScene::High - BlendScene::Low);
    }
    inr::Image fast;
    inr::Image slow;
    const inr::FrameStatistics fewer = with.render(frame, fast);
    const inr::FrameStatistics all = without.render(frame, slow);
    EXPECT_EQ(fast.pixels, slow.pixels);
    EXPECT_LT(3 * fewer.samples, 2 * all.samples);
    EXPECT_EQ(fewer.clamped, 0);
  }
}

TEST_P(Projections, OfASumStopAtOne)
{
  inr::Renderer renderer = this->renderer(false);
  inr::Frame frame = FrameOf(this->scene, BlendMode::Additive);
  frame.unitDistance = 2;
  inr::Image image;
  const std::int64_t all = renderer.render(frame, image).samples;
  frame.unitDistance = 0.4;
  inr::Image stopped;
  EXPECT_LT(renderer.render(frame, stopped).samples, all);
  int whole = 0;
  for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
    const float sum = image.pixels[k] * 5.0f; // grey
    whole += sum > 1.0f ? 1 : 0;
    EXPECT_NEAR(stopped.pixels[k], std::min(sum, 1.0f), 1e-4f) << k;
  }
  EXPECT_GT(whole, 10);
}

TEST_P(Projections, TellWhereAnExtremeIs)
{
  inr::Renderer renderer = this->renderer();
  inr::Frame frame = FrameOf(this->scene, BlendMode::MaximumIntensity);
  frame.sampleDistance = 0.05;
  inr::Image image;
  inr::Image depth;
  renderer.render(frame, image, &depth);
  const inr::RayGeometry geometry(frame, this->scene.dims);
  int shown = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const bool opaque = image.pixel(x, y)[3] >= 0.5f;
      shown += opaque ? 1 : 0;
      if (!opaque) {
        EXPECT_EQ(*depth.pixel(x, y), 1.0f);
        continue;
      }
      const glm::dvec4 clip(2 * (x + 0.5) / frame.width - 1, 2 * (y + 0.5) / frame.height - 1,
                            2.0 * *depth.pixel(x, y) - 1, 1);
      const glm::dvec4 place = frame.worldToIndex * (frame.clipToWorld * clip);
      const glm::dvec4 color = this->scene.colorOf(this->scene.at(glm::dvec3(place) / place.w));
      EXPECT_NEAR(color.w, image.pixel(x, y)[3], 4e-3);
    }
  }
  EXPECT_GT(shown, 5);
}

TEST_P(Projections, EndAtOpaqueGeometry)
{
  inr::Renderer renderer = this->renderer();
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = FrameOf(this->scene, mode);
    frame.sampleDistance = 0.05;
    const inr::Image whole = Render(renderer, frame);
    const glm::dvec4 center =
        glm::inverse(frame.clipToWorld) *
        glm::dvec4(glm::dvec3(0.8, 0.4, 0.7) * glm::dvec3(this->scene.dims), 1);
    const std::vector<float> depth(static_cast<std::size_t>(frame.width) *
                                       static_cast<std::size_t>(frame.height),
                                   static_cast<float>(0.5 * center.z / center.w + 0.5));
    frame.opaqueDepth = depth.data();
    const inr::Image half = Render(renderer, frame);
    EXPECT_NE(half.pixels, whole.pixels);
    ExpectTruth(half, this->scene, frame, 6e-3);
  }
}

TEST(Projection, OfAFileWithoutRangesAreTheSame)
{
  const BlendScene scene;
  inr::Renderer cached = scene.renderer(true, false);
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = FrameOf(scene, mode);
    frame.sampleDistance = 0.05;
    ExpectTruth(Render(cached, frame), scene, frame, 4e-3);
  }
}

TEST(Projection, DependsOnNeitherThreadsNorTheSizeOfTheCache)
{
  const BlendScene scene;
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = FrameOf(scene, mode);
    frame.levelOfDetailScale = 0.52; // levels 0 and 1, dithered
    BlendScene::Cache large;
    BlendScene::Cache small;
    small.bytes = BlendScene::SmallCache;
    large.threads = 3;
    inr::Renderer one = scene.renderer(small);
    inr::Renderer other = scene.renderer(large);
    inr::Image first;
    inr::Image second;
    EXPECT_TRUE(one.render(frame, first).complete);
    EXPECT_TRUE(other.render(frame, second).complete);
    EXPECT_EQ(first.pixels, second.pixels);
    EXPECT_GT(other.cachedBricks(), one.cachedBricks()); // it had to make do
  }
}

TEST(Projection, RefinesWithinATimeLimit)
{
  const BlendScene scene;
  for (const BlendMode mode : Modes) {
    SCOPED_TRACE(static_cast<int>(mode));
    ExpectRefinement(scene, FrameOf(scene, mode));
  }
}

TEST(Projection, RebuildsRangesForAnotherModeOnly)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(true, true);
  Render(renderer, FrameOf(scene, BlendMode::Composite));
  EXPECT_EQ(renderer.colorsVersion(), 1);
  const inr::Image before = Render(renderer, FrameOf(scene, BlendMode::Composite));
  Render(renderer, FrameOf(scene, BlendMode::MaximumIntensity));
  Render(renderer, FrameOf(scene, BlendMode::MaximumIntensity));
  EXPECT_EQ(renderer.colorsVersion(), 2);
  EXPECT_EQ(Render(renderer, FrameOf(scene, BlendMode::Composite)).pixels, before.pixels);
}

TEST(Projection, KnowsNoPathsAndNoRangeThatIsNone)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(true, true);
  inr::Frame frame = FrameOf(scene, BlendMode::MaximumIntensity);
  frame.mode = inr::RenderMode::PathTracing;
  EXPECT_THROW(Render(renderer, frame), inr::Error);
  frame = FrameOf(scene, BlendMode::AverageIntensity);
  frame.blending.averageLow = std::nan("");
  EXPECT_THROW(Render(renderer, frame), inr::Error);
}

} // namespace test::projections
