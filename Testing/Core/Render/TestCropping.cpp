// SPDX-License-Identifier: BSD-3-Clause
//
// Cropping regions, in ray marching by a sum along the rays in double, in path tracing by clipping
// planes.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Random.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Testing/Core/Render/BlendScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test::cropping {

inr::Cropping Regions(const BlendScene& scene, std::uint32_t flags)
{
  const glm::dvec3 size(scene.dims);
  return {glm::dvec3(0.3, 0.4, 0.25) * size, glm::dvec3(0.6, 0.7, 0.5) * size, flags};
}

inr::Frame FrameOf(const BlendScene& scene, std::uint32_t flags)
{
  inr::Frame frame = Oblique(glm::dvec3(scene.dims), 26);
  frame.blending.mode = inr::BlendMode::Additive;
  frame.unitDistance = 40;
  frame.sampleDistance = 0.05;
  frame.cropping = Regions(scene, flags);
  return frame;
}

/// Which region a point is in, said in another way than Cropping does.
int RegionOf(const inr::Cropping& cropping, const glm::dvec3& at)
{
  int region = 0;
  int weight = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const int planesBelow =
        (at[axis] > cropping.low[axis] ? 1 : 0) + (at[axis] > cropping.high[axis] ? 1 : 0);
    region += weight * planesBelow;
    weight *= 3;
  }
  return region;
}

double Sum(const BlendScene& scene, const inr::Frame& whole, const inr::Ray& ray)
{
  constexpr int pieces = 3000;
  double sum = 0;
  for (int k = 0; k < pieces; ++k) {
    const glm::dvec3 at = ray.at(ray.length * (k + 0.5) / pieces);
    const double value = scene.at(at);
    if ((whole.cropping->flags >> RegionOf(*whole.cropping, at) & 1u) != 0) {
      sum += scene.colorOf(value).w * value * ray.length / pieces;
    }
  }
  return std::min(sum / whole.unitDistance, 1.0);
}

double LargestError(inr::Renderer& renderer, const BlendScene& scene, const inr::Frame& frame)
{
  inr::Frame whole = frame;
  whole.cropping.reset();
  const inr::RayGeometry geometry(whole, scene.dims);
  const inr::Image image = Render(renderer, frame);
  double largest = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const inr::Ray ray = geometry.ray(x, y);
      const double truth = ray.length > 0 ? Sum(scene, frame, ray) : 0.0;
      largest = std::max(largest, std::abs(truth - image.pixel(x, y)[0]));
    }
  }
  return largest;
}

class CroppingRegions : public testing::TestWithParam<bool>
{};

INSTANTIATE_TEST_SUITE_P(, CroppingRegions, testing::Bool(), [](const auto& cached) {
  return cached.param ? std::string("Cached") : std::string("Uncached");
});

TEST_P(CroppingRegions, AnyOfThem)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(GetParam(), true);
  std::vector<std::uint32_t> cases{0,         0x7ffffff, 0x0002000, 0x2ebfeba,
                                   0x5140145, 0x0417410, 0x7be8bef, 0x1ff};
  for (std::uint64_t k = 0; k < 6; ++k) {
    cases.push_back(static_cast<std::uint32_t>(inr::RandomBits(3, k)) & 0x7ffffff);
  }
  for (const std::uint32_t flags : cases) {
    SCOPED_TRACE(flags);
    EXPECT_LT(LargestError(renderer, scene, FrameOf(scene, flags)), 4e-3);
  }
}

TEST_P(CroppingRegions, OfABoxAreItsPlanes)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(GetParam(), true);
  for (const inr::BlendMode mode : {inr::BlendMode::Composite, inr::BlendMode::MaximumIntensity}) {
    inr::Frame cropped = FrameOf(scene, 1u << 13 | 1u << 14); // the middle and what is above in x
    cropped.blending.mode = mode;
    inr::Frame clipped = cropped;
    clipped.cropping.reset();
    const inr::Cropping& box = *cropped.cropping;
    clipped.clippingPlanes = {{1, 0, 0, -box.low.x},
                              {0, 1, 0, -box.low.y},
                              {0, -1, 0, box.high.y},
                              {0, 0, 1, -box.low.z},
                              {0, 0, -1, box.high.z}};
    const inr::Image image = Render(renderer, cropped);
    EXPECT_LT(inr::ImageMaximumError(image, Render(renderer, clipped)), 1e-4f);
    EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.1f);
  }
}

TEST_P(CroppingRegions, OfABoxHoldForPathsToo)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(GetParam(), true);
  inr::Frame frame = FrameOf(scene, 0x0002000);
  frame.blending.mode = inr::BlendMode::Composite;
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 200;
  frame.unitDistance = 2;
  frame.paths.ambientLight = glm::dvec3(1);
  const inr::Image paths = Render(renderer, frame);
  frame.mode = inr::RenderMode::RayMarching;
  const inr::Image rays = Render(renderer, frame);
  double off = 0;
  for (std::size_t k = 3; k < rays.pixels.size(); k += 4) { // they agree in opacity
    off += std::abs(rays.pixels[k] - paths.pixels[k]) / static_cast<double>(rays.pixels.size() / 4);
  }
  EXPECT_LT(off, 0.01);
  frame.cropping->flags = 0x0417410; // a cross
  EXPECT_NO_THROW(Render(renderer, frame));
  frame.mode = inr::RenderMode::PathTracing;
  EXPECT_THROW(Render(renderer, frame), inr::Error);
}

TEST_P(CroppingRegions, LeaveOutWhatIsCropped)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(GetParam(), false);
  inr::Image image;
  const std::int64_t all = renderer.render(FrameOf(scene, 0x7ffffff), image).samples;
  EXPECT_LT(2 * renderer.render(FrameOf(scene, 0x0417410), image).samples, all);
  EXPECT_EQ(renderer.render(FrameOf(scene, 0), image).samples, 0);
  inr::Frame frame = FrameOf(scene, 0x0002000);
  frame.cropping->low.x = -std::numeric_limits<double>::infinity(); // no plane at all
  frame.cropping->high.x = std::numeric_limits<double>::infinity();
  EXPECT_GT(renderer.render(frame, image).samples, 0);
  frame.cropping->low.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Render(renderer, frame), inr::Error);
}

} // namespace test::cropping
