// SPDX-License-Identifier: BSD-3-Clause
//
// Isosurfaces along rays, through the cache and straight from the field, against a fine search in
// double.
#include "Core/Cache/BrickCache.h"
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Marching/Shading.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/BlendScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test::isosurfaces {

double DataOf(double normalised)
{
  return BlendScene::Low + (BlendScene::High - BlendScene::Low) * normalised;
}

inr::Frame FrameOf(const BlendScene& scene, const std::vector<double>& normalised = {0.3, 0.7, 0.9})
{
  inr::Frame frame = Oblique(glm::dvec3(scene.dims), 32);
  frame.blending.mode = inr::BlendMode::Isosurface;
  for (const double value : normalised) {
    frame.blending.isosurfaces.push_back(DataOf(value));
  }
  frame.unitDistance = 7; // means nothing here
  return frame;
}

inr::Frame LitFrame(const BlendScene& scene)
{
  inr::Frame frame = FrameOf(scene);
  frame.shading.emplace();
  inr::Light light;
  light.direction = {0.3, -1, 0.2};
  frame.lights = {light};
  return frame;
}

/// Bytes that hold no more than what a cache can do its work with.
std::int64_t SmallestCache(const glm::i64vec3& dims, inr::CacheOptions options)
{
  for (options.bytes = 1024;; options.bytes += 256) {
    try {
      inr::Renderer renderer = CachedRenderer(dims, Waves, options, 1);
      return options.bytes;
    } catch (const inr::Error&) {
      continue; // too few
    }
  }
}

struct Truth
{
  glm::dvec4 color{0.0};
  double halfAt = -1; ///< t
};

/// The fine search and what it composites.
class Search
{
public:
  Search(const BlendScene& scene, const inr::Frame& frame)
      : Scene(scene), Picture(frame), Lighting(inr::ShadingOf(frame))
  {}

  Truth along(const inr::Ray& ray) const
  {
    constexpr int pieces = 2000;
    Truth truth;
    double before = this->Scene.at(ray.at(0));
    for (int k = 0; k < pieces; ++k) {
      const double begin = ray.length * k / pieces;
      const double end = ray.length * (k + 1) / pieces;
      const double after = this->Scene.at(ray.at(end));
      this->pass(ray, begin, end, before, after, truth);
      before = after;
    }
    return truth;
  }

private:
  void pass(const inr::Ray& ray, double begin, double end, double before, double after,
            Truth& truth) const
  {
    for (const double data : this->Picture.blending.isosurfaces) {
      const double value = (data - BlendScene::Low) / (BlendScene::High - BlendScene::Low);
      if ((before < value) == (after < value)) {
        continue;
      }
      const double t = begin + (end - begin) * (value - before) / (after - before);
      const glm::dvec4 color = this->lit(ray, t, this->Scene.colorOf(value));
      truth.color += glm::dvec4(glm::dvec3(color), 1.0) * (color.w * (1.0 - truth.color.w));
      truth.halfAt = truth.halfAt < 0 && truth.color.w >= 0.5 ? t : truth.halfAt;
    }
  }

  glm::dvec4 lit(const inr::Ray& ray, double t, const glm::dvec4& color) const
  {
    if (!this->Lighting) {
      return color;
    }
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = 1;
      gradient[axis] = 0.5 * (this->Scene.at(ray.at(t) + step) - this->Scene.at(ray.at(t) - step));
    }
    const glm::vec3 lit = this->Lighting->view().shade(
        glm::vec3(color), this->Lighting->view().toEye(ray), ray.at(t), glm::vec3(gradient));
    return glm::dvec4(lit, color.w);
  }

  const BlendScene& Scene;
  const inr::Frame& Picture;
  std::optional<inr::Shading> Lighting;
};

/// Pixels that differ from the search's: a ray that only touches a surface may or may not find it.
int Wrong(const inr::Image& image, const inr::Image& depth, const BlendScene& scene,
          const inr::Frame& frame)
{
  const inr::RayGeometry geometry(frame, scene.dims);
  const Search search(scene, frame);
  int wrong = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const inr::Ray ray = geometry.ray(x, y);
      const Truth truth = search.along(ray);
      const double z = truth.halfAt >= 0 ? geometry.windowDepth(ray.at(truth.halfAt)) : 1.0;
      double off = 10 * std::abs(z - *depth.pixel(x, y));
      for (int channel = 0; channel < 4; ++channel) {
        off = std::max(off, std::abs(image.pixel(x, y)[channel] - truth.color[channel]));
      }
      wrong += off > 0.004 ? 1 : 0;
    }
  }
  return wrong;
}

int Wrong(inr::Renderer& renderer, const BlendScene& scene, const inr::Frame& frame)
{
  inr::Image image;
  inr::Image depth;
  renderer.render(frame, image, &depth);
  const auto shown =
      std::count_if(depth.pixels.begin(), depth.pixels.end(), [](float z) { return z < 1.0f; });
  EXPECT_GT(shown, 8);
  return Wrong(image, depth, scene, frame);
}

class Isosurfaces : public testing::TestWithParam<bool>
{
protected:
  BlendScene scene;

  inr::Renderer renderer(bool ranges = true) const
  {
    return this->scene.renderer(this->GetParam(), ranges);
  }
};

INSTANTIATE_TEST_SUITE_P(, Isosurfaces, testing::Bool(), [](const auto& cached) {
  return cached.param ? std::string("Cached") : std::string("Uncached");
});

TEST_P(Isosurfaces, AreWhereTheFieldTakesTheirValues)
{
  inr::Renderer renderer = this->renderer();
  for (const double distance : {0.2, 1.0}) {
    inr::Frame frame = FrameOf(this->scene);
    frame.sampleDistance = distance;
    EXPECT_LE(Wrong(renderer, this->scene, frame), 1) << distance;
  }
}

TEST_P(Isosurfaces, AreLitByTheirGradients)
{
  inr::Renderer renderer = this->renderer();
  const inr::Frame frame = LitFrame(this->scene);
  EXPECT_LE(Wrong(renderer, this->scene, frame), 1);
  inr::Frame unlit = frame;
  unlit.shading.reset();
  EXPECT_NE(Render(renderer, frame).pixels, Render(renderer, unlit).pixels);
}

TEST_P(Isosurfaces, AreInOrderWithinAStep)
{
  inr::Renderer renderer = this->renderer();
  inr::Frame frame = FrameOf(this->scene, {0.75, 0.6, 0.7, 0.65}); // not sorted
  frame.sampleDistance = 3;
  EXPECT_LE(Wrong(renderer, this->scene, frame), 4); // more are only touched between samples
}

TEST_P(Isosurfaces, SkipCellsWithoutThemAndShowTheSame)
{
  inr::Renderer with = this->renderer();
  inr::Renderer without = this->renderer(false);
  for (const inr::Frame& frame : {FrameOf(this->scene), LitFrame(this->scene)}) {
    inr::Image fast;
    inr::Image slow;
    const inr::FrameStatistics fewer = with.render(frame, fast);
    const inr::FrameStatistics all = without.render(frame, slow);
    EXPECT_LT(inr::ImageMaximumError(fast, slow), 1e-3f);
    EXPECT_LT(3 * fewer.samples, 2 * all.samples);
    EXPECT_EQ(fewer.clamped, 0);
  }
}

TEST_P(Isosurfaces, EndAtOpaqueGeometry)
{
  inr::Renderer renderer = this->renderer();
  inr::Frame frame = FrameOf(this->scene);
  const glm::dvec4 inside = glm::inverse(frame.clipToWorld) *
                            glm::dvec4(glm::dvec3(0.4, 0.5, 0.5) * glm::dvec3(this->scene.dims), 1);
  const std::vector<float> depth(static_cast<std::size_t>(frame.width * frame.height),
                                 static_cast<float>(0.5 * inside.z / inside.w + 0.5));
  const inr::Image whole = Render(renderer, frame);
  frame.opaqueDepth = depth.data();
  EXPECT_NE(Render(renderer, frame).pixels, whole.pixels);
  EXPECT_LE(Wrong(renderer, this->scene, frame), 1);
}

TEST_P(Isosurfaces, BeginRightBehindAClippingPlane)
{
  inr::Renderer renderer = this->renderer();
  inr::Frame frame = FrameOf(this->scene);
  frame.sampleDistance = 2;
  frame.clippingPlanes = {{0.2, -1, 0.1, 0.55 * static_cast<double>(this->scene.dims.y)}};
  EXPECT_LE(Wrong(renderer, this->scene, frame), 3);
}

TEST_P(Isosurfaces, ThatNobodyCanSeeCostNothing)
{
  inr::Renderer renderer = this->renderer();
  inr::Image image;
  // Not in the volume's range, transparent, none.
  for (const std::vector<double>& values :
       {std::vector<double>{-0.2, 1.3}, std::vector<double>{0.5}, std::vector<double>{}}) {
    EXPECT_EQ(renderer.render(FrameOf(this->scene, values), image).samples, 0);
    EXPECT_EQ(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.0f);
  }
}

TEST(Isosurface, DependsOnNeitherThreadsNorTheSizeOfTheCache)
{
  const BlendScene scene;
  inr::Frame frame = LitFrame(scene);
  frame.levelOfDetailScale = 0.52; // levels 0 and 1
  BlendScene::Cache large;
  large.threads = 3;
  BlendScene::Cache small;
  small.bytes = BlendScene::SmallCache;
  inr::Renderer one = scene.renderer(small);
  inr::Renderer other = scene.renderer(large);
  inr::Image first;
  inr::Image second;
  EXPECT_TRUE(one.render(frame, first).complete);
  EXPECT_TRUE(other.render(frame, second).complete);
  EXPECT_EQ(first.pixels, second.pixels);
  EXPECT_GT(other.cachedBricks(), one.cachedBricks());
}

/// Many surfaces around a corner of bricks of 9 voxels, lit, seen from either side.
class AtACorner : public testing::TestWithParam<std::tuple<double, double>>
{
protected:
  static double distance() { return std::get<1>(GetParam()); }
  /// Of the volume: several steps.
  static std::int64_t edge() { return distance() > 100 ? 1025 : 33; }
  static glm::i64vec3 dims() { return glm::i64vec3(edge()); }

  static inr::Frame frame()
  {
    const glm::dvec3 corner(0.5 * static_cast<double>(edge() - 1));
    const double far = static_cast<double>(edge());
    const glm::dvec3 from = corner - far * std::get<0>(GetParam()) * glm::dvec3(0.6, 0.66, 0.72);
    inr::Frame frame;
    frame.width = frame.height = 12;
    frame.clipToWorld = glm::inverse(glm::ortho(-1.5, 1.5, -1.5, 1.5, 0.0, 3 * far) *
                                     glm::lookAt(from, corner, glm::dvec3(0.1, 1, 0)));
    frame.levelOfDetailScale = 0;
    frame.sampleDistance = distance(); // a step may cross all of them, and bricks
    frame.blending.mode = inr::BlendMode::Isosurface;
    frame.blending.isosurfaces = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    frame.shading.emplace();
    frame.lights = {inr::Light{}};
    return frame;
  }
  static inr::CacheOptions cache() { return Options(inr::CachePrecision::Float32, 9); }
  static inr::Renderer renderer(const inr::CacheOptions& cache)
  {
    const auto size = static_cast<float>(edge());
    const auto field = [size](const glm::vec3& u) {
      const float along = (u.x + u.y + u.z - 1.5f) * size; // the corner is at u = 0.5
      return std::clamp(0.5f + along / 6, 0.0f, 1.0f);
    };
    inr::Renderer renderer = CachedRenderer(dims(), field, cache, 1);
    renderer.setTransferFunction(UniformMedium(0.2f));
    return renderer;
  }
};

INSTANTIATE_TEST_SUITE_P(Isosurfaces, AtACorner,
                         testing::Combine(testing::Values(1.0, -1.0),
                                          testing::Values(4.0, 40.0, 400.0)));

// What the light of them all depends on is eight bricks; the smallest cache has seven, beside the
// one that is always there.
TEST_P(AtACorner, ComesFromTheSmallestCache)
{
  inr::CacheOptions smallest = cache();
  smallest.bytes = SmallestCache(dims(), smallest);
  inr::Renderer large = renderer(cache());
  inr::Renderer small = renderer(smallest);
  const inr::Image truth = Render(large, frame());
  inr::Image picture;
  int asked = 0;
  small.render(frame(), picture, nullptr, [&] { return ++asked < 100000; });
  EXPECT_EQ(small.cachedBricks(), inr::BrickCache::FewestBricks);
  EXPECT_GT(large.cachedBricks(), small.cachedBricks());
  EXPECT_EQ(picture.pixels, truth.pixels);
  EXPECT_NEAR(truth.pixel(6, 6)[3], 1 - std::pow(0.8, 9), 0.02); // it does cross them all
}

TEST(Isosurface, RefinesWithinATimeLimit)
{
  const BlendScene scene;
  ExpectRefinement(scene, LitFrame(scene));
}

TEST(Isosurface, OfACoarseLevelIsNearThatOfTheFinest)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(true, true);
  inr::Frame frame = FrameOf(scene, {0.7});
  const inr::Image fine = Render(renderer, frame);
  frame.levelOfDetailScale = 0.6;
  const inr::Image coarse = Render(renderer, frame);
  EXPECT_NE(coarse.pixels, fine.pixels);
  int differ = 0;
  for (std::size_t k = 3; k < fine.pixels.size(); k += 4) {
    differ += std::abs(fine.pixels[k] - coarse.pixels[k]) > 0.01f ? 1 : 0;
  }
  EXPECT_LE(differ, 4); // at the rim
}

TEST(Isosurface, NeedsFiniteValuesAndNoPaths)
{
  const BlendScene scene;
  inr::Renderer renderer = scene.renderer(true, true);
  inr::Frame frame = FrameOf(scene, {0.7, std::numeric_limits<double>::infinity()});
  EXPECT_THROW(Render(renderer, frame), inr::Error);
  frame = FrameOf(scene);
  frame.mode = inr::RenderMode::PathTracing;
  EXPECT_THROW(Render(renderer, frame), inr::Error);
}

} // namespace test::isosurfaces
