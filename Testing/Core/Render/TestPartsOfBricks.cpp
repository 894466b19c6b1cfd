// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures from bricks of which only what can be seen is inferred, against those from whole ones.
#include "Testing/Core/Render/HiddenScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

constexpr glm::i64vec3 Dims(96, 83, 90);

/// Shells in some places, and nothing elsewhere.
float Drops(const glm::vec3& u)
{
  float value = 0.1f;
  for (const glm::vec3 at : {glm::vec3(0.3f, 0.3f, 0.4f), glm::vec3(0.75f, 0.6f, 0.7f)}) {
    value = std::max(value, 1.0f - 4.0f * glm::length(u - at));
  }
  return value;
}

const Voxels& Truth()
{
  static const Voxels voxels(Dims, Drops);
  return voxels;
}

/// Two renderers of the same field, one of which trusts no range and infers whole bricks.
struct Pair
{
  explicit Pair(const inr::CacheOptions& cache, int cell = 8)
  {
    const auto field = [](const glm::vec3& u) { return Truth().at(u); };
    for (const auto provenance :
         {inr::MacroCellProvenance::Decoded, inr::MacroCellProvenance::File}) {
      inr::MacroCells cells = CellsOf(field, Dims, cell);
      cells.provenance = provenance;
      inr::RendererOptions options;
      options.threads = 2;
      options.cache = cache;
      this->renderers.emplace_back(std::make_shared<FieldEvaluator>(field), VolumeOf(Dims), cells,
                                   options);
    }
    this->colour(Shell(0));
  }

  void colour(const inr::TransferFunction& function)
  {
    for (inr::Renderer& renderer : this->renderers) {
      renderer.setTransferFunction(function);
    }
  }

  /// Both to the end: the same picture, with so many points for bricks.
  void compare(const inr::Frame& frame, std::int64_t (&points)[2])
  {
    inr::Image pictures[2];
    for (const std::size_t k : {0, 1}) {
      inr::FrameStatistics statistics;
      points[k] = 0;
      int frames = 0;
      do {
        statistics = this->renderers[k].render(frame, pictures[k]);
        points[k] += statistics.work.bricks.points;
        ASSERT_LT(++frames, 5000);
      } while (!statistics.complete);
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
    EXPECT_GT(*std::max_element(pictures[0].pixels.begin(), pictures[0].pixels.end()), 0.2f);
  }

  std::vector<inr::Renderer> renderers;
};

inr::CacheOptions Cache() { return Options(inr::CachePrecision::Float32, 24); }

inr::Frame FrameOf(double levelOfDetailScale)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 64);
  frame.levelOfDetailScale = levelOfDetailScale;
  frame.unitDistance = 4;
  return frame;
}

/// Of all, of neighbouring levels in turn, and coarse ones.
class PartsOfBricks : public testing::TestWithParam<double>
{};
INSTANTIATE_TEST_SUITE_P(Scales, PartsOfBricks, testing::Values(0.0, 0.9, 1.5, 3.1));

TEST_P(PartsOfBricks, ShowWhatWholeOnesDo)
{
  Pair pair(Cache());
  std::int64_t points[2];
  pair.compare(FrameOf(GetParam()), points);
  EXPECT_LT(points[0], (GetParam() < 1 ? 0.6 : 1.01) * static_cast<double>(points[1]));
  EXPECT_GT(points[0], 0);
}

TEST_P(PartsOfBricks, ReachAsFarAsGradients)
{
  Pair pair(Cache());
  inr::Frame frame = FrameOf(GetParam());
  frame.shading = inr::Material{};
  frame.lights = {inr::Light{}};
  std::int64_t points[2];
  pair.compare(frame, points);
  EXPECT_LT(points[0], (GetParam() < 1 ? 0.8 : 1.01) * static_cast<double>(points[1]));
  frame.shading.reset(); // which needs less
  pair.compare(frame, points);
  EXPECT_EQ(points[0], 0);
}

TEST_P(PartsOfBricks, ScatterAsWholeOnesDo)
{
  Pair pair(Cache());
  inr::Frame frame = FrameOf(GetParam());
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 3;
  frame.lights = {inr::Light{}};
  std::int64_t points[2];
  pair.compare(frame, points);
  EXPECT_LT(points[0], (GetParam() < 1 ? 0.6 : 1.01) * static_cast<double>(points[1]));
}

// Where cells are small, those of a coarser level reach beyond the blocks that a level shows.
TEST(PartsOfSmallBricks, LetPathsPassThroughWhatIsHidden)
{
  inr::Frame frame = FrameOf(0);
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 2;
  frame.lights = {inr::Light{}};
  for (const double scale : {1.5, 2.2, 3.0}) {
    Pair pair(Options(inr::CachePrecision::Float32, 8), 3);
    frame.levelOfDetailScale = scale;
    std::int64_t points[2];
    pair.compare(frame, points);
    EXPECT_LE(points[0], points[1]);
  }
}

/// Opaque within a tenth of a value.
inr::TransferFunction Around(float value, float otherwise = 0)
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    const bool isShown = std::abs(x - value) < 0.1f;
    function.table.emplace_back(x, 1 - x, 0.5f, isShown ? 0.3f : otherwise);
  }
  function.below = function.above = function.table.front();
  return function;
}

TEST_P(PartsOfBricks, AreCompletedForOtherColours)
{
  Pair pair(Cache());
  std::int64_t points[2];
  const inr::Frame frame = FrameOf(GetParam());
  for (const float value : {0.85f, 0.3f, 0.6f}) {
    pair.colour(Around(value));
    pair.compare(frame, points);
  }
  EXPECT_EQ(points[0], 0); // between the others
  pair.colour(Around(0.6f, 0.002f));
  pair.compare(frame, points);
}

// Whatever was looked at before, and by whom, in any precision.
TEST_P(PartsOfBricks, AreRoundedAsWholeOnesAre)
{
  const auto field =
      std::make_shared<FieldEvaluator>([](const glm::vec3& u) { return Truth().at(u); });
  const inr::MacroCells cells = CellsOf([](const glm::vec3& u) { return Truth().at(u); }, Dims, 8);
  for (const auto precision :
       {inr::CachePrecision::Float32, inr::CachePrecision::Bits16, inr::CachePrecision::Bits8}) {
    inr::RendererOptions options;
    options.threads = 2;
    options.cache = Cache();
    options.cache.precision = precision;
    const inr::Frame frame = FrameOf(GetParam());
    const auto makeRenderer = [&](const std::shared_ptr<const inr::Evaluator>& evaluator) {
      return inr::Renderer(evaluator, VolumeOf(Dims), cells, options);
    };
    inr::Renderer fresh = makeRenderer(std::make_shared<FieldEvaluator>(*field));
    fresh.setTransferFunction(Around(0.6f));
    Drawn first;
    inr::Image samples[2];
    first.statistics = fresh.render(frame, first.picture, nullptr, {}, &samples[0]);
    inr::Renderer other = makeRenderer(field);
    other.setTransferFunction(Around(0.3f));
    Draw(other, frame);
    inr::Renderer late = makeRenderer(field); // shares the bricks
    late.setTransferFunction(Around(0.6f));
    Drawn second;
    second.statistics = late.render(frame, second.picture, nullptr, {}, &samples[1]);
    EXPECT_EQ(first.picture.pixels, second.picture.pixels);
    EXPECT_EQ(samples[0].pixels, samples[1].pixels);
    EXPECT_LT(second.statistics.work.bricks.bricks, first.statistics.work.bricks.bricks);
  }
}

// Modes that look at values in other places, before and after one that does not.
TEST_P(PartsOfBricks, AreCompletedWhereMoreIsLookedAt)
{
  Pair pair(Cache());
  std::int64_t points[2];
  inr::Frame plain = FrameOf(GetParam());
  pair.compare(plain, points);
  inr::Frame other = plain;
  other.preIntegration = true;
  pair.compare(other, points);
  other = plain;
  other.blending.mode = inr::BlendMode::MaximumIntensity;
  pair.compare(other, points);
  other = plain;
  other.blending.mode = inr::BlendMode::Isosurface;
  other.blending.isosurfaces = {0.65};
  pair.compare(other, points);
  pair.compare(plain, points);
}

// In a cache of an eighth of the bricks, and in little time at once.
TEST_P(PartsOfBricks, ComeAndGo)
{
  inr::CacheOptions cache = Cache();
  cache.bytes = 10 * (24 * 24 * 24 * 4 + 2000);
  cache.background = false;
  for (const double limit : {0.0, 1e-4}) {
    Pair pair(cache);
    inr::Frame frame = FrameOf(GetParam());
    frame.timeLimit = limit;
    std::int64_t points[2];
    pair.compare(frame, points);
  }
}

// Where a level stands in for a finer one, nothing is shown of what is not known.
TEST_P(PartsOfBricks, StandInForFinerOnes)
{
  inr::CacheOptions cache = Cache();
  cache.onlyWhatFits = true;
  cache.background = false;
  for (const std::int64_t bricks : {10, 14, 24}) {
    cache.bytes = bricks * (24 * 24 * 24 * 4 + 2000);
    for (const bool preloading : {false, true}) {
      cache.preloading = preloading;
      Pair pair(cache);
      std::int64_t points[2];
      pair.compare(FrameOf(GetParam()), points);
    }
  }
}

} // namespace
