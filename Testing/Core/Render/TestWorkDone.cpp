// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the work that a frame reports is what the field was really asked.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/RecordingField.h"

#include <chrono>
#include <thread>

namespace test::work_done {

constexpr std::int64_t BytesOfABrick = 9 * 9 * 9 * 2;

inr::Frame Surfaces(const glm::i64vec3& dims)
{
  inr::Frame frame = ShadedView(dims);
  frame.blending.mode = inr::BlendMode::Isosurface;
  frame.blending.isosurfaces = {0.6, 0.8};
  return frame;
}

/// All that the field was asked since the scene was made is in the work of the frames since then.
void ExpectReported(const RecordedScene& scene, const inr::WorkDone& work)
{
  EXPECT_EQ(work.networkSamples, scene.field->scattered());
  EXPECT_EQ(work.bricks.points, scene.field->inGrids());
}

TEST(WorkDone, IsAllThatTheFieldWasAsked)
{
  for (const bool cached : {false, true}) {
    for (const auto& view : {Oblique(glm::dvec3(47, 41, 44)), ShadedView({47, 41, 44}),
                             Surfaces({47, 41, 44}), PathView({47, 41, 44})}) {
      SCOPED_TRACE(cached);
      RecordedScene scene(SmallBricks(cached));
      const inr::WorkDone work = scene.render(view);
      ExpectReported(scene, work);
      EXPECT_EQ(work.bricks.bricks, scene.renderer.cachedBricks());
      EXPECT_EQ(work.bricks.bytes, scene.renderer.cachedBricks() * BytesOfABrick);
      EXPECT_EQ(work.networkSamples > 0, !cached);
      EXPECT_EQ(work.bricks.bricks > 0, cached);
      EXPECT_GT(work.cells, 0);
    }
  }
}

TEST(WorkDone, IsReportedWhereTheCacheIsTooSmall)
{
  for (const auto& view :
       {Oblique(glm::dvec3(47, 41, 44)), ShadedView({47, 41, 44}), PathView({47, 41, 44})}) {
    inr::RendererOptions options = SmallBricks();
    options.cache.bytes = 40000;
    RecordedScene scene(options);
    const inr::WorkDone work = scene.render(view);
    ExpectReported(scene, work);
    const bool paths = view.mode == inr::RenderMode::PathTracing;
    EXPECT_GE(work.bricks.bricks, scene.renderer.cachedBricks() * (paths ? 1 : 2));
    EXPECT_LE(work.bricks.bytes, work.bricks.bricks * BytesOfABrick);
    EXPECT_EQ(work.networkSamples > 0, paths);
  }
}

TEST(WorkDone, OfSeveralCallsAddsUp)
{
  for (const std::int64_t bytes : {std::int64_t{64} << 20, std::int64_t{40000}}) {
    for (inr::Frame view : {ShadedView({47, 41, 44}), PathView({47, 41, 44})}) {
      inr::RendererOptions options = SmallBricks();
      options.deterministic = true;
      options.cache.bytes = bytes;
      RecordedScene scene(options);
      view.timeLimit = 1;
      inr::WorkDone work;
      for (int k = 0; k < 2000 && (k == 0 || !scene.statistics.complete); ++k) {
        work.add(scene.render(view));
      }
      EXPECT_TRUE(scene.statistics.complete);
      ExpectReported(scene, work);
    }
  }
}

TEST(WorkDone, HoldsWhatTheLoaderBroughtInBetween)
{
  inr::RendererOptions options = SmallBricks();
  options.cache.background = true;
  RecordedScene scene(options);
  inr::Frame frame = Oblique(glm::dvec3(scene.dims));
  frame.timeLimit = 1e-4;
  inr::WorkDone work = scene.render(frame);
  // What the loader has begun it finishes, and is taken over at the next call.
  for (int k = 0;
       k < 5000 && (!scene.statistics.complete || work.bricks.points != scene.field->inGrids());
       ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    work.add(scene.render(frame));
  }
  ExpectReported(scene, work);
  EXPECT_EQ(work.bricks.bricks, scene.renderer.cachedBricks());
}

TEST(WorkDone, CountsAGradientForEverySampleThatIsLit)
{
  for (const bool cached : {false, true}) {
    RecordedScene scene(SmallBricks(cached));
    scene.renderer.setTransferFunction(UniformMedium(0.001f));
    const inr::Frame frame = ShadedView(scene.dims);
    scene.render(frame); // with everything there nothing is done twice
    const inr::WorkDone work = scene.render(frame);
    const std::int64_t samples = scene.statistics.samples;
    EXPECT_GT(work.gradients, 5000);
    EXPECT_EQ(work.gradients, cached ? samples : samples / 7);
    EXPECT_EQ(work.networkSamples, cached ? 0 : samples);
  }
}

TEST(WorkDone, CountsScatteringsAndStepsTowardsLights)
{
  RecordedScene scene(SmallBricks(false)); // nothing is traced twice
  scene.renderer.setTransferFunction(UniformMedium(0.2f));
  inr::Frame frame = PathView(scene.dims, 1);
  frame.paths.maximumBounces = 1;
  inr::Image image;
  const inr::FrameStatistics lit = scene.renderer.render(frame, image);
  std::int64_t collided = 0;
  for (std::size_t k = 3; k < image.pixels.size(); k += 4) {
    collided += image.pixels[k] == 1.0f ? 1 : 0;
  }
  EXPECT_GT(collided, 300);
  EXPECT_EQ(lit.work.scatterings, collided); // each path's first collision, and no other
  EXPECT_GT(lit.work.lightSteps, 0);
  EXPECT_LT(lit.work.lightSteps, lit.samples);

  frame.lights.clear();
  const inr::WorkDone unlit = scene.render(frame);
  EXPECT_EQ(unlit.scatterings, collided);
  EXPECT_EQ(unlit.lightSteps, 0);
  frame.paths.emissionOnly = true;
  EXPECT_EQ(scene.render(frame).scatterings, 0);
}

TEST(WorkDone, CountsTheMacroCellsOnARaysWay)
{
  const glm::i64vec3 dims(8, 8, 160);
  inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  for (inr::ValueRange& range : cells.ranges) {
    range = {0.2f, 0.8f};
  }
  for (const bool cached : {false, true}) {
    const auto field = [](const glm::vec3&) { return 0.5f; };
    RecordedScene scene(SmallBricks(cached), field, dims, cells);
    scene.renderer.setTransferFunction(UniformMedium(1e-6f));
    const inr::Frame frame = ParallelFrame(1, {2, 2}, {6, 6}, -1, 200);
    scene.render(frame);
    const inr::WorkDone work = scene.render(frame);
    EXPECT_GE(work.cells, 10); // one after the other,
    EXPECT_LE(work.cells, 20); // and again where a stretch of samples begins
    scene.renderer.setTransferFunction(UniformMedium(0));
    EXPECT_LE(scene.render(frame).cells, 3); // all at once
  }
}

TEST(WorkDone, CountsACellOnceWhereRaysWaitForBricks)
{
  RecordedScene scene(SmallBricks());
  scene.renderer.setTransferFunction(UniformMedium(0.001f));
  const inr::Frame frame = Oblique(glm::dvec3(scene.dims));
  const inr::WorkDone waiting = scene.render(frame);
  const inr::WorkDone again = scene.render(frame);
  EXPECT_GT(waiting.bricks.bricks, 100);
  EXPECT_EQ(again.bricks.bricks, 0);
  EXPECT_EQ(waiting.cells, again.cells);
}

} // namespace test::work_done
