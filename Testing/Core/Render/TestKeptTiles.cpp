// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that are asked for again while bricks come in: of those, only the tiles are marched
// again for which much of what they lacked has come.
#include "Core/Image/Metrics.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/RecordingField.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace test::kept_tiles {

constexpr glm::i64vec3 Dims(97, 83, 91);

inr::RendererOptions FewAtATime(int bricks = 9)
{
  inr::RendererOptions options = SmallBricks();
  options.deterministic = true;
  options.cache.maximumRequests = bricks;
  return options;
}

inr::Frame Limited(double levelOfDetailScale = 0, int size = 130)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), size);
  frame.levelOfDetailScale = levelOfDetailScale;
  frame.timeLimit = 1;
  return frame;
}

/// As a call to a renderer gives it.
struct Given
{
  Given(inr::Renderer& renderer, const inr::Frame& frame)
      : statistics(renderer.render(frame, this->rgba, &this->depth, {}, &this->samples))
  {}

  inr::Image rgba;
  inr::Image depth;
  inr::Image samples;
  inr::FrameStatistics statistics;
};

void ExpectTheSame(const Given& a, const Given& b)
{
  EXPECT_EQ(a.rgba.pixels, b.rgba.pixels);
  EXPECT_EQ(a.depth.pixels, b.depth.pixels);
  for (std::size_t k = 0; k < a.samples.pixels.size(); k += 2) {
    ASSERT_EQ(a.samples.pixels[k], b.samples.pixels[k]) << k / 2;
    // Where levels are mixed, samples of either count as of the finer one if that is there.
    ASSERT_NEAR(a.samples.pixels[k + 1], b.samples.pixels[k + 1], 1) << k / 2;
  }
  EXPECT_EQ(a.statistics.rays, b.statistics.rays);
  EXPECT_EQ(a.statistics.samples, b.statistics.samples);
  EXPECT_EQ(a.statistics.missed, b.statistics.missed);
  // Behind where a ray ends, fewer are counted where a coarser brick stood in.
  const auto hidden = static_cast<double>(a.statistics.hidden);
  EXPECT_NEAR(hidden, static_cast<double>(b.statistics.hidden), 0.01 * hidden);
  EXPECT_EQ(a.statistics.levels.finest, b.statistics.levels.finest);
  EXPECT_EQ(a.statistics.levels.coarsest, b.statistics.levels.coarsest);
}

/// A picture until it is complete, in calls that load a few bricks each.
struct Course
{
  /// `forgets`: all of it is marched at each call, as the colours change in between.
  Course(const inr::Frame& frame, int bricks, bool forgets) : scene(FewAtATime(bricks), Waves, Dims)
  {
    do {
      if (forgets) {
        this->scene.renderer.setTransferFunction(OpacityRamp(0.1f));
        this->scene.renderer.setTransferFunction(Colours());
      }
      this->last = std::make_unique<Given>(this->scene.renderer, frame);
      this->missed.push_back(this->last->statistics.missed);
      this->cells += this->last->statistics.work.cells;
      this->points += this->last->statistics.work.bricks.points;
    } while (!this->last->statistics.complete && this->missed.size() < 2000);
  }

  RecordedScene scene;
  std::unique_ptr<Given> last;
  std::vector<std::int64_t> missed; ///< samples, call by call
  std::int64_t cells = 0;           ///< that all calls went through
  std::int64_t points = 0;          ///< that all calls loaded
};

/// How much of the work a picture takes that it takes when it is forgotten from call to call. It is
/// complete after as many calls, and not far behind in the midst of it.
double ShareOfWork(const inr::Frame& frame, int bricks = 40)
{
  const Course kept(frame, bricks, false);
  const Course anew(frame, bricks, true);
  EXPECT_TRUE(kept.last->statistics.complete);
  ExpectTheSame(*kept.last, *anew.last);
  EXPECT_GT(anew.missed.size(), 5u);
  EXPECT_LE(kept.missed.size(), anew.missed.size() + 1);
  EXPECT_NEAR(static_cast<double>(kept.points) / static_cast<double>(anew.points), 1, 0.02);
  for (std::size_t k = 0; k < std::min(kept.missed.size(), anew.missed.size()); ++k) {
    EXPECT_LT(kept.missed[k] - anew.missed[k], anew.missed[0] / 2) << k;
  }
  return static_cast<double>(kept.cells) / static_cast<double>(anew.cells);
}

TEST(KeptTiles, EndWithThePictureOfAllTilesMarchedAgain)
{
  EXPECT_LT(ShareOfWork(Limited(1.05), 9), 0.1); // levels 0 and 1, mixed in between
}

TEST(KeptTiles, DoSoInAllModes)
{
  EXPECT_LT(ShareOfWork(Limited(0, 60)), 0.25);
  inr::Frame lit = Limited(0, 60);
  lit.shading = inr::Material{};
  lit.lights = {Headlight()};
  EXPECT_LT(ShareOfWork(lit), 0.25);
  inr::Frame layered = Limited(0, 60);
  AddLayerHalfWay(layered);
  EXPECT_LT(ShareOfWork(layered), 0.25);
  inr::Frame integrated = Limited(0, 60);
  integrated.preIntegration = true;
  EXPECT_LT(ShareOfWork(integrated), 0.25);
  inr::Frame largest = Limited(0, 60);
  largest.blending.mode = inr::BlendMode::MaximumIntensity;
  EXPECT_LT(ShareOfWork(largest), 0.25);
  inr::Frame surfaces = Limited(0, 60);
  surfaces.blending.mode = inr::BlendMode::Isosurface;
  surfaces.blending.isosurfaces = {0.6, 0.8};
  EXPECT_LT(ShareOfWork(surfaces), 0.25);
}

/// Whether the cache has room for all of it, or for so little that rays wait.
TEST(KeptTiles, HaveWhatWasNotAskedForAtFirst)
{
  for (const std::int64_t bytes : {64 << 20, 300000}) {
    inr::RendererOptions options = FewAtATime();
    options.cache.bytes = bytes;
    RecordedScene whole(options, Waves, Dims);
    inr::Frame frame = Limited();
    frame.timeLimit = 0;
    const Given truth(whole.renderer, frame);
    RecordedScene scene(options, Waves, Dims);
    inr::Image image;
    for (int k = 0; k < 5; ++k) {
      EXPECT_FALSE(scene.renderer.render(Limited(), image).complete);
    }
    int frames = 0;
    for (bool complete = false; !complete && frames < 5000; ++frames) {
      const Given given(scene.renderer, Limited());
      complete = given.statistics.complete;
      if (complete) {
        EXPECT_EQ(given.rgba.pixels, truth.rgba.pixels);
        EXPECT_EQ(given.depth.pixels, truth.depth.pixels);
      }
      for (std::size_t k = 0; frames == 0 && k < given.depth.pixels.size(); ++k) {
        EXPECT_GT(given.depth.pixels[k], 0.5f);
        EXPECT_EQ(given.samples.pixels[2 * k] > 0, given.samples.pixels[2 * k + 1] >= 0);
      }
    }
    EXPECT_LT(frames, 5000);
  }
}

TEST(KeptTiles, AreLeftWhereTheViewOrTheColoursChange)
{
  RecordedScene scene(FewAtATime(), Waves, Dims);
  inr::Frame other = Limited();
  other.clipToWorld[0][0] *= 1.1;
  const inr::TransferFunction functions[] = {Colours(), OpacityRamp(0.2f)};
  for (int k = 0; k < 40; ++k) { // three calls of each
    const inr::Frame frame = k / 3 % 2 == 0 ? Limited() : other;
    scene.renderer.setTransferFunction(functions[k / 6 % 2]);
    const Given given(scene.renderer, frame);
    RecordedScene fresh(FewAtATime(), Waves, Dims);
    fresh.renderer.setTransferFunction(functions[k / 6 % 2]);
    inr::Frame whole = frame;
    whole.timeLimit = 0;
    const Given truth(fresh.renderer, whole);
    if (given.statistics.complete) {
      EXPECT_EQ(given.rgba.pixels, truth.rgba.pixels);
    } else { // the same picture, less sharp
      EXPECT_GT(inr::ImagePsnr(given.rgba, truth.rgba), 18) << k;
    }
  }
}

} // namespace test::kept_tiles
