// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures from bricks of which only what can be seen is inferred, against those from whole ones.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/HiddenScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::parts_of_bricks {

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

/// At the corners of bricks of 24 voxels, which share a layer, of this level and of coarser ones:
/// so what stands for unknown voxels, the first one that is known, can be seen where it is shown.
float Studs(const glm::vec3& u)
{
  const glm::vec3 voxel = u * glm::vec3(Dims) - 0.5f;
  const glm::vec3 from = glm::abs(voxel - 23.0f * glm::round(voxel / 23.0f));
  return std::max({from.x, from.y, from.z}) < 3.0f ? 0.67f : 0.1f;
}

const Voxels& StuddedTruth()
{
  static const Voxels voxels(Dims, Studs);
  return voxels;
}

/// Two renderers of the same field, one of which trusts no range and infers whole bricks.
struct Pair
{
  explicit Pair(const inr::CacheOptions& cache, int cell = 8, const Voxels& truth = Truth())
  {
    const auto field = [&truth](const glm::vec3& u) { return truth.at(u); };
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

  /// Both to the end: the same picture, with so many points for bricks. How bright it is.
  float compare(const inr::Frame& frame, std::int64_t (&points)[2])
  {
    inr::Image pictures[2];
    for (const std::size_t k : {0, 1}) {
      inr::FrameStatistics statistics;
      points[k] = 0;
      int frames = 0;
      do {
        statistics = this->renderers[k].render(frame, pictures[k]);
        points[k] += statistics.work.bricks.points;
        ++frames;
      } while (!statistics.complete && frames < 5000);
      EXPECT_TRUE(statistics.complete);
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
    return *std::max_element(pictures[0].pixels.begin(), pictures[0].pixels.end());
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
INSTANTIATE_TEST_SUITE_P(Scales, PartsOfBricks, testing::Values(0.0, 1.05, 1.75, 3.1));

TEST_P(PartsOfBricks, ShowWhatWholeOnesDo)
{
  Pair pair(Cache());
  std::int64_t points[2];
  EXPECT_GT(pair.compare(FrameOf(GetParam()), points), 0.2f);
  EXPECT_LT(points[0], (GetParam() < 1.5 ? 0.6 : 1.01) * static_cast<double>(points[1]));
  EXPECT_GT(points[0], 0);
}

TEST_P(PartsOfBricks, HideWhatTheyDoNotKnow)
{
  Pair pair(Cache(), 4, StuddedTruth());
  std::int64_t points[2];
  const float brightest = pair.compare(FrameOf(GetParam()), points);
  EXPECT_EQ(brightest > 0.2f, GetParam() < 1.5); // coarser levels average them away
}

TEST_P(PartsOfBricks, ReachAsFarAsGradients)
{
  Pair pair(Cache());
  inr::Frame frame = FrameOf(GetParam());
  frame.shading = inr::Material{};
  frame.lights = {inr::Light{}};
  std::int64_t points[2];
  EXPECT_GT(pair.compare(frame, points), 0.2f);
  EXPECT_LT(points[0], (GetParam() < 1.5 ? 0.8 : 1.01) * static_cast<double>(points[1]));
  frame.shading.reset(); // which needs less
  EXPECT_GT(pair.compare(frame, points), 0.2f);
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
  EXPECT_GT(pair.compare(frame, points), 0.2f);
  EXPECT_LT(points[0], (GetParam() < 1.5 ? 0.6 : 1.01) * static_cast<double>(points[1]));
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
    EXPECT_GT(pair.compare(frame, points), 0.2f);
    EXPECT_LE(points[0], points[1]);
  }
}

/// Opaque near a value.
inr::TransferFunction Around(float value, float width = 0.1f, float otherwise = 0)
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    const bool isShown = std::abs(x - value) < width;
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
    EXPECT_GT(pair.compare(frame, points), 0.2f);
  }
  EXPECT_EQ(points[0], 0); // between the others
  pair.colour(Around(0.6f, 0.1f, 0.002f));
  EXPECT_GT(pair.compare(frame, points), 0.2f);
}

// Whatever was looked at before, and by whom, in any precision; of bricks much of whose range is in
// places that are not looked at.
TEST_P(PartsOfBricks, AreRoundedAsWholeOnesAre)
{
  static const Voxels slope(Dims,
                            [](const glm::vec3& u) { return std::min(glm::length(u), 1.0f); });
  const auto at = [](const glm::vec3& u) { return slope.at(u); };
  const auto field = std::make_shared<FieldEvaluator>(at);
  const inr::MacroCells cells = CellsOf(at, Dims, 4);
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
    fresh.setTransferFunction(Around(0.6f, 0.03f));
    Drawn first;
    inr::Image samples[2];
    first.statistics = fresh.render(frame, first.picture, nullptr, {}, &samples[0]);
    inr::Renderer other = makeRenderer(field);
    other.setTransferFunction(Around(0.55f, 0.03f));
    Draw(other, frame);
    inr::Renderer late = makeRenderer(field); // shares the bricks
    late.setTransferFunction(Around(0.6f, 0.03f));
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
  EXPECT_GT(pair.compare(plain, points), 0.2f);
  inr::Frame other = plain;
  other.preIntegration = true;
  EXPECT_GT(pair.compare(other, points), 0.2f);
  other = plain;
  other.blending.mode = inr::BlendMode::MaximumIntensity;
  EXPECT_GT(pair.compare(other, points), 0.2f);
  other = plain;
  other.blending.mode = inr::BlendMode::Isosurface;
  other.blending.isosurfaces = {0.65};
  EXPECT_GT(pair.compare(other, points), 0.2f);
  EXPECT_GT(pair.compare(plain, points), 0.2f);
}

// And where samples are chosen for a tolerance: there, ranges have to hold, so both trust them.
TEST_P(PartsOfBricks, AreCompletedForATolerance)
{
  Pair pairs[2] = {Pair(Cache(), 4, StuddedTruth()), Pair(Cache(), 4, StuddedTruth())};
  inr::Frame frame = FrameOf(GetParam());
  Draw(pairs[0].renderers[0], frame);
  frame.errorTolerance = 2;
  const Drawn late = Draw(pairs[0].renderers[0], frame);
  EXPECT_EQ(late.picture.pixels, Draw(pairs[1].renderers[0], frame).picture.pixels);
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
    EXPECT_GT(pair.compare(frame, points), 0.2f);
  }
}

// Where a level stands in for a finer one, nothing is shown of what is not known.
TEST_P(PartsOfBricks, StandInForFinerOnes)
{
  inr::CacheOptions cache = Cache();
  cache.onlyWhatFits = true;
  cache.ranking = false; // samples that are hidden do not count
  cache.background = false;
  for (const Voxels* truth : {&Truth(), &StuddedTruth()}) {
    for (const std::int64_t bricks : {10, 14, 24}) {
      cache.bytes = bricks * (24 * 24 * 24 * 4 + 2000);
      for (const bool preloading : {false, true}) {
        cache.preloading = preloading;
        Pair pair(cache, 4, *truth);
        std::int64_t points[2];
        const float brightest = pair.compare(FrameOf(GetParam()), points);
        EXPECT_TRUE(brightest > 0.2f || truth == &StuddedTruth());
      }
    }
  }
}

} // namespace test::parts_of_bricks
