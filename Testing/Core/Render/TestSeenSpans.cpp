// SPDX-License-Identifier: BSD-3-Clause
//
// What of rays is known to show nothing, against their ways through all macro-cells.
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Core/Render/MacroCells/SeenSpans.h"
#include "Core/Render/Paths/PathTracer.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::seen_spans {

constexpr int Levels = 5;
const glm::i64vec3 VolumeDims(160, 96, 130);

double Random(std::uint64_t seed, std::uint64_t k) { return 2.0 * inr::RandomUnit(seed, k) - 1.0; }

/// With one in so many cells visible.
inr::Majorants FewVisible(std::uint64_t seed, std::uint64_t oneIn)
{
  inr::MacroCells cells = inr::MakeMacroCells(VolumeDims, 16);
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const float value = inr::RandomBits(seed, k) % oneIn == 0 ? 0.9f : 0.1f;
    cells.ranges[k] = {value, value};
  }
  inr::TransferFunction function;
  for (const float opacity : {0.0f, 0.0f, 0.5f}) {
    function.table.emplace_back(1, 1, 1, opacity);
  }
  inr::Majorants majorants(cells, VolumeDims, inr::Arena(1));
  majorants.update(inr::ColorTable(function, inr::VolumeInfo{}), inr::Arena(1));
  return majorants;
}

/// Of any kind: from far, near, inside, of parallel rays, of a sheared volume.
inr::Frame AnyView(std::uint64_t seed)
{
  const glm::dvec3 dims(VolumeDims);
  const glm::dvec3 direction =
      glm::normalize(glm::dvec3(Random(seed, 0), Random(seed, 1), Random(seed, 2)));
  const double distance = seed % 4 == 0 ? 0.1 : 1.0 + 1.5 * (1.0 + Random(seed, 3));
  const glm::dvec3 eye = 0.5 * dims + 100.0 * distance * direction;
  const glm::dvec3 aim = 0.5 * dims + 20.0 * glm::dvec3(Random(seed, 4), Random(seed, 5), 0);
  const glm::dmat4 projection =
      seed % 3 == 0
          ? glm::ortho(-90.0, 90.0, -70.0, 70.0, 1.0, 1000.0)
          : glm::perspective(glm::radians(seed % 4 == 0 ? 110.0 : 40.0), 1.3, 1.0, 1000.0);
  inr::Frame frame;
  frame.width = 83;
  frame.height = 67;
  frame.clipToWorld = glm::inverse(projection * glm::lookAt(eye, aim, glm::dvec3(0.1, 1, 0.2)));
  if (seed % 11 == 0) {
    frame.clipToWorld *= -2.0; // the same view
  }
  if (seed % 5 == 0) {
    frame.worldToIndex[1][0] = 0.4;
    frame.worldToIndex[2][2] = -1.5;
    frame.worldToIndex[3] = glm::dvec4(3, -5, 190, 1);
  }
  frame.levelOfDetailScale = seed % 2 == 0 ? 0.0 : 1.5;
  return frame;
}

/// Goes through all cells of a ray; the part of it from the first visible one to the last.
inr::SeenSpan LookAtAll(const inr::Ray& ray, const inr::Majorants& majorants, double scale)
{
  inr::CellWalker cells(majorants.view(), glm::dvec3(VolumeDims), ray, scale, Levels);
  inr::SeenSpan seen{inr::Infinite, -inr::Infinite};
  for (double t = 0; t < ray.length; t = cells.exit()) {
    cells.moveTo(t);
    if (cells.extinction() > 0) {
      seen.begin = std::min(seen.begin, std::max(cells.enter(), 0.0));
      seen.end = std::min(cells.exit(), ray.length);
    }
  }
  return seen;
}

TEST(SeenSpans, HoldAllThatCanBeSeen)
{
  int empty = 0;
  int shorter = 0;
  int rays = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const inr::Majorants majorants = FewVisible(seed, seed % 7 == 6 ? 1 : 150);
    const inr::Frame frame = AnyView(seed);
    const inr::RayGeometry geometry(frame, VolumeDims);
    const inr::SeenSpans spans(geometry.view(), majorants.view(), glm::dvec3(VolumeDims),
                               frame.levelOfDetailScale, Levels);
    for (int k = 0; k < frame.width * frame.height; ++k) {
      const int x = k % frame.width;
      const int y = k / frame.width;
      const inr::Ray ray = geometry.ray(x, y);
      if (!(ray.length > 0)) {
        continue;
      }
      const inr::SeenSpan truth = LookAtAll(ray, majorants, frame.levelOfDetailScale);
      const inr::SeenSpan span = spans.of(ray, x, y);
      ASSERT_TRUE(truth.empty() || (span.begin <= truth.begin && span.end >= truth.end))
          << seed << ": " << x << ", " << y;
      ASSERT_TRUE(span.empty() || !spans.isEmpty(x, y)) << seed;
      ++rays;
      empty += span.empty() ? 1 : 0;
      shorter += !span.empty() && (span.begin > 0.2 * ray.length || span.end < 0.8 * ray.length);
    }
  }
  EXPECT_GT(empty, rays / 10);
  EXPECT_GT(shorter, rays / 10);
}

TEST(SeenSpans, AreOfWholeTiles)
{
  const inr::Majorants majorants = FewVisible(1, 150);
  const inr::Frame frame = AnyView(1);
  const inr::RayGeometry geometry(frame, VolumeDims);
  const inr::SeenSpans spans(geometry.view(), majorants.view(), glm::dvec3(VolumeDims), 0, Levels);
  for (const int edge : {16, 32}) {
    const inr::Tiling tiling(frame.width, frame.height, edge);
    for (std::int64_t k = 0; k < tiling.count(); ++k) {
      const inr::Tile tile = tiling.tile(k);
      bool empty = true;
      for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
        empty = empty && spans.isEmpty(tile.x + pixel % tile.width, tile.y + pixel / tile.width);
      }
      EXPECT_EQ(spans.isEmpty(tile), empty) << edge << " " << k;
    }
  }
}

/// Footprints for which only the coarsest cells are bounds, which are the whole volume.
TEST(SeenSpans, AreOfCellsThatBoundAllLevels)
{
  const inr::Majorants majorants = FewVisible(2, 150);
  const inr::Frame frame = AnyView(1);
  const inr::RayGeometry geometry(frame, VolumeDims);
  const auto emptyTiles = [&](double scale) {
    const inr::SeenSpans spans(geometry.view(), majorants.view(), glm::dvec3(VolumeDims), scale,
                               Levels);
    const inr::Tiling tiling(frame.width, frame.height);
    int empty = 0;
    for (std::int64_t k = 0; k < tiling.count(); ++k) {
      empty += spans.isEmpty(tiling.tile(k)) ? 1 : 0;
    }
    return empty;
  };
  ASSERT_LT(majorants.coarsestLevel(0), Levels - 1);
  EXPECT_GT(emptyTiles(1e-3), emptyTiles(1e3));
  EXPECT_EQ(emptyTiles(1e-3), emptyTiles(0));
}

/// A field of its own for every point.
class NoiseSampler : public inr::FieldSampler
{
public:
  void sample(const inr::FieldPoint* points, std::int64_t count, float* values) override
  {
    for (std::int64_t k = 0; k < count; ++k) {
      const auto voxel = static_cast<std::uint64_t>(points[k].voxel.x + 1000 * points[k].voxel.y);
      values[k] = inr::RandomUnit(voxel, static_cast<std::uint64_t>(points[k].voxel.z));
    }
  }
};

/// The colour of a path that looks at every cell on its way.
glm::vec4 FollowWhole(const inr::PathScene& scene, int x, int y)
{
  NoiseSampler sampler;
  inr::PathState path(scene, x, y);
  inr::PathSample sample{};
  inr::FieldPoint point{};
  float value = 0;
  bool goesOn = path.ray.length > 0;
  while (goesOn && inr::PlaceSample(scene, path, sample, point)) {
    sampler.sample(&point, 1, &value);
    inr::ClampToRange(sample.range, value);
    goesOn = inr::Collide(scene, path, sample.majorant, value);
  }
  return {path.radiance, path.collided ? 1.0f : 0.0f};
}

TEST(SeenSpans, ChangeNoPath)
{
  inr::TransferFunction function = OpacityRamp(0.9f);
  const inr::ColorTable colors(function, inr::VolumeInfo{});
  int shown = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const inr::Majorants majorants = FewVisible(seed, 60);
    inr::Frame frame = AnyView(seed);
    frame.mode = inr::RenderMode::PathTracing;
    frame.unitDistance = 4;
    frame.paths.ambientLight = glm::vec3(1);
    const inr::RayGeometry geometry(frame, VolumeDims);
    const inr::PathTracer tracer(frame, geometry, VolumeDims, majorants, colors.lookup(), Levels);
    NoiseSampler sampler;
    inr::Image rgba(frame.width, frame.height, 4);
    inr::Image depth(frame.width, frame.height, 1);
    std::fill(rgba.pixels.begin(), rgba.pixels.end(), -1.0f);
    const inr::Tiling tiling(frame.width, frame.height);
    for (std::int64_t k = 0; k < tiling.count(); ++k) {
      tracer.trace(tiling.tile(k), sampler, rgba, &depth);
    }
    for (int k = 0; k < frame.width * frame.height; ++k) {
      const int x = k % frame.width;
      const int y = k / frame.width;
      const glm::vec4 truth = FollowWhole(tracer.scene(), x, y);
      const float* pixel = rgba.pixel(x, y);
      ASSERT_EQ(glm::vec4(pixel[0], pixel[1], pixel[2], pixel[3]), truth) << seed;
      shown += truth.w > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(shown, 1000);
}

/// Cells of which few can be seen, of a field that shows where: around a corner of the volume.
class SeenCorner : public testing::Test
{
protected:
  static constexpr glm::vec3 Center{0.75f, 0.3f, 0.7f};
  const glm::i64vec3 Dims{70, 50, 60};

  static float corner(const glm::vec3& u)
  {
    const float inside = 0.2f - glm::length(u - Center);
    return glm::clamp(4.0f * inside + 0.1f * inside * Waves(u), 0.0f, 1.0f);
  }

  inr::Renderer renderer() const
  {
    inr::MacroCells cells = inr::MakeMacroCells(this->Dims, 8);
    cells.provenance = inr::MacroCellProvenance::Training;
    for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
      const auto at = static_cast<std::int64_t>(k);
      const glm::dvec3 cell(at % cells.dims.x, at / cells.dims.x % cells.dims.y,
                            at / (cells.dims.x * cells.dims.y));
      const glm::dvec3 middle = (cell + 0.5) * cells.spacing;
      const double reach = 0.2 + 0.7 * glm::length(cells.spacing);
      cells.ranges[k] = {0.0f, glm::length(middle - glm::dvec3(Center)) < reach ? 1.0f : 0.0f};
    }
    inr::Renderer renderer = FieldRenderer(this->Dims, corner, cells, 2, true);
    inr::TransferFunction function = OpacityRamp(0.4f);
    function.table.insert(function.table.begin() + 1, glm::vec4(0.2f, 0.9f, 0.4f, 0.1f));
    renderer.setTransferFunction(function);
    return renderer;
  }

  inr::Frame frame() const
  {
    inr::Frame frame = Oblique(glm::dvec3(this->Dims), 150);
    frame.levelOfDetailScale = 1;
    frame.unitDistance = 3;
    return frame;
  }

  struct Pictures
  {
    inr::Image rgba;
    inr::Image depth;
    inr::Image samples;
    inr::FrameStatistics statistics;
  };
  Pictures draw(const inr::Frame& frame) const
  {
    Pictures pictures;
    inr::Renderer drawing = this->renderer();
    pictures.statistics =
        drawing.render(frame, pictures.rgba, &pictures.depth, {}, &pictures.samples);
    return pictures;
  }

  /// The same view with all w below 0, which is as if cells were behind the camera: no tile is
  /// empty then.
  void expectTheSameWithoutEmptyTiles(const inr::Frame& frame) const
  {
    inr::Frame flipped = frame;
    flipped.clipToWorld *= -1.0;
    const Pictures drawn = this->draw(frame);
    const Pictures truth = this->draw(flipped);
    EXPECT_GT(drawn.statistics.samples, 1000);
    EXPECT_EQ(drawn.statistics.samples, truth.statistics.samples);
    EXPECT_TRUE(drawn.rgba.pixels == truth.rgba.pixels);
    EXPECT_TRUE(drawn.depth.pixels == truth.depth.pixels);
    EXPECT_TRUE(drawn.samples.pixels == truth.samples.pixels);
  }
};

TEST_F(SeenCorner, LeavesRaysOut)
{
  inr::Frame flipped = this->frame();
  flipped.clipToWorld *= -1.0;
  EXPECT_LT(this->draw(this->frame()).statistics.rays,
            0.8 * static_cast<double>(this->draw(flipped).statistics.rays));
}

TEST_F(SeenCorner, IsDrawnInEveryMode)
{
  for (const inr::BlendMode mode :
       {inr::BlendMode::Composite, inr::BlendMode::MaximumIntensity,
        inr::BlendMode::MinimumIntensity, inr::BlendMode::AverageIntensity,
        inr::BlendMode::Additive, inr::BlendMode::Isosurface}) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::Frame frame = this->frame();
    frame.blending.mode = mode;
    frame.blending.isosurfaces = {0.3, 0.5};
    this->expectTheSameWithoutEmptyTiles(frame);
  }
}

TEST_F(SeenCorner, IsDrawnBetweenLayers)
{
  inr::Frame frame = this->frame();
  for (const float depth : {0.89f, 0.9f, 0.91f, 0.93f}) {
    AddLayer(frame, depth, {0.1f, 0.2f, 0.3f, 0.5f});
  }
  this->expectTheSameWithoutEmptyTiles(frame);
}

} // namespace test::seen_spans
