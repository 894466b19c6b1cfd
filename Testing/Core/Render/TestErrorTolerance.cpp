// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures with Frame::errorTolerance against those with every sample from the full resolution.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Tolerance/LevelChooser.h"
#include "Testing/Core/Image/PixelDifferences.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::error_tolerance {

TEST(ErrorTolerance, OfZeroIsTheFullResolution)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame plain = FrameWith({});
  plain.levelOfDetailScale = 0;
  plain.adaptiveSampling = false;
  inr::Frame exact = FrameWith(0.0);
  exact.levelOfDetailScale = 3; // does not matter
  const Drawn drawn = Draw(renderer, exact);
  EXPECT_EQ(drawn.picture.pixels, Render(renderer, plain).pixels);
  EXPECT_EQ(drawn.statistics.levels.coarsest, 0);
}

TEST(ErrorTolerance, IsKeptWithFewerSamples)
{
  inr::Renderer renderer = MakeRenderer();
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  double last = static_cast<double>(exact.statistics.samples);
  for (const double tolerance : {0.5, 2.0, 8.0}) {
    const Drawn drawn = Draw(renderer, FrameWith(tolerance));
    EXPECT_GE(ShareWithin(tolerance, PixelDifferences(drawn.picture, exact.picture)), 0.999)
        << tolerance;
    EXPECT_LE(static_cast<double>(drawn.statistics.samples), last);
    last = static_cast<double>(drawn.statistics.samples);
  }
  EXPECT_LT(last, 0.4 * static_cast<double>(exact.statistics.samples));
}

TEST(ErrorTolerance, IsKeptAtAnySampleDistance)
{
  inr::Renderer renderer = MakeRenderer();
  for (const double distance : {0.3, 1.0, 2.0, 5.0}) {
    inr::Frame frame = FrameWith(0.0);
    frame.sampleDistance = distance;
    const Drawn exact = Draw(renderer, frame);
    frame.errorTolerance = 4.0;
    const Drawn drawn = Draw(renderer, frame);
    EXPECT_GE(ShareWithin(4.0, PixelDifferences(drawn.picture, exact.picture)), 0.999) << distance;
    EXPECT_LE(drawn.statistics.samples, exact.statistics.samples) << distance;
  }
}

/// As of files of other programs: values are moved into the ranges of the cells that they are in,
/// and of those that are walked through together with them.
TEST(ErrorTolerance, SparesNothingWhereRangesAreNotToBeTrusted)
{
  inr::MacroCells cells = CellsOf(FogAndWires, FoggyDims);
  cells.provenance = inr::MacroCellProvenance::File;
  cells.apron = glm::dvec3(0);
  for (inr::ValueRange& range : cells.ranges) {
    const float width = range.high - range.low;
    range.low += 0.3f * width;
    range.high -= 0.3f * width;
  }
  inr::Renderer renderer = MakeRenderer(64 << 20, 2, cells);
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  const Drawn drawn = Draw(renderer, FrameWith(8.0));
  EXPECT_EQ(drawn.picture.pixels, exact.picture.pixels);
  EXPECT_GT(exact.statistics.clamped, 0);
}

/// Where rays that look ahead are several pixels apart.
TEST(ErrorTolerance, IsKeptBetweenTheRaysThatLookAhead)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith(0.0);
  frame.width = frame.height = 200;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 2.0;
  const Drawn drawn = Draw(renderer, frame);
  EXPECT_GE(ShareWithin(2.0, PixelDifferences(drawn.picture, exact.picture)), 0.999);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples);
}

TEST(ErrorTolerance, KeepsThinThingsThatDistanceAloneLoses)
{
  inr::Renderer renderer = MakeRenderer();
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  const Drawn tolerant = Draw(renderer, FrameWith(8.0));
  inr::Frame far = FrameWith({});
  far.adaptiveSampling = false;
  far.levelOfDetailScale = 1;
  Drawn distant = Draw(renderer, far);
  while (distant.statistics.samples > tolerant.statistics.samples) {
    far.levelOfDetailScale *= 1.1;
    distant = Draw(renderer, far);
  }
  EXPECT_GE(inr::ImagePsnr(tolerant.picture, exact.picture),
            inr::ImagePsnr(distant.picture, exact.picture) + 10);
}

TEST(ErrorTolerance, AsksForNextToNothingWhereColoursAreTheSame)
{
  inr::Renderer renderer = MakeRenderer();
  renderer.setTransferFunction(UniformMedium(0.01f));
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  const Drawn drawn = Draw(renderer, FrameWith(0.01));
  EXPECT_LT(255 * inr::ImageMaximumError(drawn.picture, exact.picture), 0.01);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples / 6);
  EXPECT_EQ(drawn.statistics.levels.finest, inr::LevelErrors::Coarsest);
}

/// With next to no tolerance, in a medium of one colour: a part of the exact samples, at most.
Drawn ExpectFewSamples(const FieldEvaluator::Function& field, const glm::i64vec3& dims,
                       float opacity, std::int64_t part)
{
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(dims),
                         CellsOf(field, dims), options);
  renderer.setTransferFunction(UniformMedium(opacity));
  inr::Frame frame = Oblique(glm::dvec3(dims), 40);
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 0.01;
  Drawn drawn = Draw(renderer, frame);
  EXPECT_LT(255 * inr::ImageMaximumError(drawn.picture, exact.picture), 0.01);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples / part);
  return drawn;
}

/// And shows nothing beyond it, where values reach but do not pass the end.
TEST(ErrorTolerance, AsksForNoMoreWhereATableEndsWithTheData)
{
  const auto field = [](const glm::vec3& u) {
    return glm::clamp(0.5f + 2 * std::cos(40 * u.x), 0.0f, 1.0f);
  };
  ExpectFewSamples(field, glm::i64vec3(96), 0.01f, 6);
}

/// Where every cell has to be measured for it.
TEST(ErrorTolerance, AsksForFewSamplesOfTheCoarsestLevelWhereThatIsAsGood)
{
  const glm::i64vec3 dims(96);
  const auto slope = [](const glm::vec3& u) { return 0.4f + 0.2f * u.x; };
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(slope), VolumeOf(dims),
                         CellsOf(slope, dims), options);
  renderer.setTransferFunction(Glow());
  inr::Frame frame = Oblique(glm::dvec3(dims), 40);
  frame.unitDistance = 20;
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 8;
  const Drawn drawn = Draw(renderer, frame);
  EXPECT_LT(255 * inr::ImageMaximumError(drawn.picture, exact.picture), 8);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples / 3);
  EXPECT_EQ(drawn.statistics.levels.coarsest, inr::LevelErrors::Coarsest);
  EXPECT_GT(drawn.statistics.work.networkSamples, 0);
}

/// Which has no coarser level, but samples further apart.
TEST(ErrorTolerance, IsKeptInASingleBrick)
{
  const Drawn drawn = ExpectFewSamples(FogAndWires, {15, 14, 15}, 0.3f, 3);
  EXPECT_EQ(drawn.statistics.levels.coarsest, 0);
}

TEST(ErrorTolerance, DrawsTheSameWhateverTheCacheHolds)
{
  inr::Renderer roomy = MakeRenderer(64 << 20, 2);
  inr::Renderer narrow = MakeRenderer(400 << 10, 1);
  const inr::Frame frame = FrameWith(2.0);
  EXPECT_EQ(Draw(roomy, frame).picture.pixels, Draw(narrow, frame).picture.pixels);
  roomy.setTransferFunction(UniformMedium(0.2f)); // and whatever was drawn before
  Draw(roomy, FrameWith(20.0));
  roomy.setTransferFunction(Glow());
  EXPECT_EQ(Draw(roomy, frame).picture.pixels, Draw(narrow, frame).picture.pixels);
}

TEST(ErrorTolerance, IsNotForWhatIsLitCroppedOrProjected)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith({});
  const auto expectExact = [&](const inr::Frame& wanted) {
    inr::Frame exact = wanted;
    exact.errorTolerance = 0;
    inr::Frame tolerant = wanted;
    tolerant.errorTolerance = 30;
    EXPECT_EQ(Draw(renderer, tolerant).picture.pixels, Draw(renderer, exact).picture.pixels);
  };
  frame.shading = inr::Material{};
  frame.lights = {inr::Light{}};
  expectExact(frame);
  frame.shading.reset();
  frame.blending.mode = inr::BlendMode::MaximumIntensity;
  expectExact(frame);
  frame.blending = {};
  frame.cropping = inr::Cropping{{30, 30, 30}, {80, 70, 80}, 1 << 13 | 1 << 0}; // and a corner
  expectExact(frame);
}

/// What is known of one tolerance is enough for smaller ones and, here, for other colours.
TEST(ErrorTolerance, MeasuresNothingTwice)
{
  inr::Renderer renderer = MakeRenderer();
  EXPECT_EQ(Draw(renderer, FrameWith(0.0)).statistics.work.networkSamples, 0);
  const Drawn first = Draw(renderer, FrameWith(4.0));
  const auto measured = first.statistics.work.networkSamples;
  EXPECT_GE(measured, FoggyDims.x * FoggyDims.y * FoggyDims.z);
  EXPECT_LT(measured,
            2.3 * static_cast<double>(FoggyDims.x * FoggyDims.y * FoggyDims.z)); // blocks overlap
  EXPECT_EQ(Draw(renderer, FrameWith(2.0)).statistics.work.networkSamples, 0);
  renderer.setTransferFunction(UniformMedium(0.2f));
  EXPECT_EQ(Draw(renderer, FrameWith(2.0)).statistics.work.networkSamples, 0);
}

/// From next to no colours to such that show everything, and back.
TEST(ErrorTolerance, IsForTheColoursThereAre)
{
  inr::TransferFunction flat = Glow();
  for (glm::vec4& entry : flat.table) {
    entry = glm::vec4(0.2f, 0.6f, 0.8f, 0.02f + 0.01f * entry.w);
  }
  const inr::Frame frame = FrameWith(2.0);
  inr::Renderer renderer = MakeRenderer();
  renderer.setTransferFunction(flat);
  const Drawn before = Draw(renderer, frame);
  renderer.setTransferFunction(Glow());
  const Drawn glowing = Draw(renderer, frame);
  renderer.setTransferFunction(flat);
  const Drawn after = Draw(renderer, frame);
  inr::Renderer other = MakeRenderer();
  EXPECT_EQ(glowing.picture.pixels, Draw(other, frame).picture.pixels);
  EXPECT_LT(before.statistics.samples, glowing.statistics.samples / 2);
  EXPECT_EQ(after.picture.pixels, before.picture.pixels);
  EXPECT_EQ(after.statistics.samples, before.statistics.samples);
}

TEST(ErrorTolerance, MustBeAFiniteNumberFromZeroOn)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Image picture;
  for (const double tolerance : {-1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(renderer.render(FrameWith(tolerance), picture), inr::Error);
  }
}

TEST(ErrorTolerance, HasPiecesThatMakeUpTheWhole)
{
  inr::Renderer renderer = MakeRenderer();
  for (const double tolerance : {1.0, 2.0, 3.0, 4.0, 6.0}) {
    inr::Frame frame = FrameWith(tolerance);
    const inr::Image whole = Draw(renderer, frame).picture;
    const glm::dvec4 cut(1, 0.2, 0.3, -81.4);
    frame.piece = {cut}; // the viewer is on this side
    const inr::Image near = Draw(renderer, frame).picture;
    frame.piece = {-cut};
    inr::Image blended = near;
    const inr::Image behind = Draw(renderer, frame).picture;
    for (std::size_t k = 0; k < blended.pixels.size(); ++k) {
      blended.pixels[k] += (1 - near.pixels[k / 4 * 4 + 3]) * behind.pixels[k];
    }
    // Rays end where they are opaque enough, at another place when what is in front is not known.
    EXPECT_LT(inr::ImageMaximumError(blended, whole), 2e-3f) << tolerance;
    EXPECT_GT(inr::ImageMaximumError(near, whole), 0.02f);
  }
}

} // namespace test::error_tolerance
