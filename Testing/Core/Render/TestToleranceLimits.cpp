// SPDX-License-Identifier: BSD-3-Clause
//
// How much is measured for Frame::errorTolerance, and how long it may take.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <atomic>

namespace test::tolerance_limits {

/// Macro-cells of 300 voxels would have to be known at once.
TEST(ToleranceLimits, TakesEverySampleOfWhatIsTooMuchToMeasure)
{
  const glm::i64vec3 dims(600, 600, 600);
  inr::MacroCells cells = inr::MakeMacroCells(dims, 300);
  std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0, 1});
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(FogAndWires), VolumeOf(dims), cells,
                         options);
  renderer.setTransferFunction(Glow());
  inr::Frame frame = Oblique(glm::dvec3(dims), 4);
  frame.width = frame.height = 4;
  frame.unitDistance = 20;
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 20;
  const Drawn drawn = Draw(renderer, frame);
  EXPECT_EQ(drawn.picture.pixels, exact.picture.pixels);
  EXPECT_EQ(drawn.statistics.samples, exact.statistics.samples);
  EXPECT_EQ(drawn.statistics.work.networkSamples, 0); // for nothing but bricks
}

/// However short a frame's time is, the next one is further.
TEST(ToleranceLimits, ComesAboutInLimitedTime)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith({});
  frame.adaptiveSampling = false;
  frame.levelOfDetailScale = 1;
  frame.width = frame.height = 24;
  EXPECT_GT(Draw(renderer, frame).statistics.levels.finest, 0); // shown meanwhile: it is there
  frame.errorTolerance = 4.0;
  frame.timeLimit = 1e-3;
  inr::Image picture;
  inr::FrameStatistics statistics = renderer.render(frame, picture);
  EXPECT_FALSE(statistics.complete);
  EXPECT_EQ(statistics.missed, 0);
  int frames = 1;
  for (; !statistics.complete; ++frames) {
    ASSERT_LT(frames, 2000);
    statistics = renderer.render(frame, picture);
  }
  EXPECT_GT(frames, 2); // eight blocks on two threads
  inr::Renderer unhurried = MakeRenderer();
  frame.timeLimit = 0;
  EXPECT_LE(inr::ImageMaximumError(picture, Draw(unhurried, frame).picture), 2e-3f);
}

/// Whether to go on is asked for each cell, as a block of small ones takes seconds.
TEST(ToleranceLimits, CanBeStoppedWhileABlockIsMeasured)
{
  const glm::i64vec3 dims(32, 32, 32);
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(FogAndWires), VolumeOf(dims),
                         CellsOf(FogAndWires, dims, 2), options);
  renderer.setTransferFunction(Glow());
  inr::Frame frame = Oblique(glm::dvec3(dims), 24);
  frame.errorTolerance = 0;
  std::atomic<int> asked{0};
  const auto count = [&] {
    ++asked;
    return true;
  };
  inr::Image picture;
  renderer.render(frame, picture, nullptr, count);
  const int before = asked.exchange(0);
  frame.errorTolerance = 4;
  EXPECT_THROW(renderer.render(frame, picture, nullptr, [&] { return ++asked < 20; }), inr::Error);
  EXPECT_LT(asked, 30);
  asked = 0;
  renderer.render(frame, picture, nullptr, count);
  EXPECT_GT(asked, before + 500);
}

/// A row of blocks of 64^3 cells of a voxel, eight of which may be known: next to nothing of each
/// can be seen.
class RowOfBlocks
{
public:
  RowOfBlocks() : Renderer(makeRenderer()) {}

  /// At these voxels along x; those that rays meet are the same wherever it looks.
  Drawn look(int from, int to, double tolerance = 20)
  {
    inr::Frame frame;
    frame.width = (to + 1 - from) / 8;
    frame.height = 16;
    frame.unitDistance = 20;
    frame.errorTolerance = tolerance;
    frame.clipToWorld =
        glm::inverse(glm::ortho(from - 0.5, to + 0.5, -0.5, 63.5, -100.0, 100.0) *
                     glm::lookAt(glm::dvec3(0), glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0)) *
                     glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 1, 1)));
    return Draw(this->Renderer, frame);
  }

private:
  static inr::Renderer makeRenderer();

  inr::Renderer Renderer;
};

inr::Renderer RowOfBlocks::makeRenderer()
{
  const glm::i64vec3 dims(640, 64, 64);
  const auto spots = [](const glm::vec3& u) {
    const glm::vec3 off = glm::mod(glm::vec3(u.x * 10, u.y, u.z), 1.0f) - 0.5f;
    return std::exp(-60 * glm::dot(off, off));
  };
  inr::MacroCells cells = inr::MakeMacroCells(dims, 1);
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const auto cell = static_cast<std::int64_t>(k);
    const glm::vec3 at(cell % 640, cell / 640 % 64, cell / (640 * 64));
    const float value = spots((at + 0.5f) / glm::vec3(dims));
    cells.ranges[k] = {0.6f * value, std::min(1.0f, 1.6f * value + 0.01f)};
  }
  cells.apron = 1.0 / glm::dvec3(dims);
  cells.provenance = inr::MacroCellProvenance::Decoded;
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(spots), VolumeOf(dims), cells, options);
  inr::TransferFunction function;
  for (int k = 0; k < 256; ++k) {
    function.table.emplace_back(1, 0.5f, 0, 0.1f * static_cast<float>(std::max(0, k - 128)) / 127);
  }
  renderer.setTransferFunction(function);
  return renderer;
}

TEST(ToleranceLimits, ForgetWhatIsNoLongerSeen)
{
  RowOfBlocks row;
  const Drawn left = row.look(0, 319);
  EXPECT_GT(left.statistics.work.networkSamples, 0);
  EXPECT_EQ(row.look(0, 319).statistics.work.networkSamples, 0);
  EXPECT_GT(row.look(320, 639).statistics.work.networkSamples, 0);
  const Drawn again = row.look(0, 319);
  EXPECT_EQ(again.statistics.work.networkSamples, left.statistics.work.networkSamples);
  EXPECT_EQ(again.picture.pixels, left.picture.pixels);
  EXPECT_EQ(row.look(0, 319).statistics.work.networkSamples, 0);
}

/// And not by what had been measured when there was less to see.
TEST(ToleranceLimits, MeasureNothingWhereTooManyCellsAreSeen)
{
  RowOfBlocks row;
  EXPECT_LT(row.look(0, 319).statistics.samples, row.look(0, 319, 0).statistics.samples);
  const Drawn known = row.look(0, 639);
  EXPECT_EQ(known.statistics.work.networkSamples, 0);
  const Drawn fresh = RowOfBlocks().look(0, 639);
  EXPECT_EQ(known.statistics.samples, fresh.statistics.samples);
  EXPECT_EQ(known.picture.pixels, fresh.picture.pixels);
}

} // namespace test::tolerance_limits
