// SPDX-License-Identifier: BSD-3-Clause
//
// What blocks of bricks hide, where samples are moved into the ranges of macro-cells.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/HiddenScene.h"

#include <algorithm>

namespace test::hidden_ranges {

constexpr glm::i64vec3 Cube(64, 64, 64);

// Of a value that the cache rounds to one that is transparent, but whose cell's range says better.
TEST(HiddenRanges, ShowsWhatRoundingHides)
{
  int seen = 0;
  for (int k = 0; k < 9; ++k) {
    const float value = 0.3f + 0.0005f * static_cast<float>(k);
    const auto field = [=](const glm::vec3& u) {
      return u.x < 0.05f ? 0.0f : (u.x > 0.95f ? 1.0f : value); // so that quanta are large
    };
    inr::RendererOptions options;
    options.cache = Options(inr::CachePrecision::Bits8, 65);
    inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(Cube),
                           CellsOf(field, Cube, 8), options);
    inr::TransferFunction narrow = UniformMedium(0.5f);
    narrow.low = double{value} - 1e-4;
    narrow.high = double{value} + 1e-4;
    narrow.below = narrow.above = glm::vec4(0);
    inr::Frame frame = Oblique(glm::dvec3(Cube), 32);
    frame.unitDistance = 20;
    renderer.setTransferFunction(narrow);
    const inr::Image picture = Render(renderer, frame);
    narrow.below = narrow.above = glm::vec4(0, 0, 0, Invisible);
    renderer.setTransferFunction(narrow);
    ExpectSame(picture, Render(renderer, frame));
    seen += *std::max_element(picture.pixels.begin(), picture.pixels.end()) > 0.5f ? 1 : 0;
  }
  EXPECT_EQ(seen, 9);
}

// Layers so thin that a coarser level does not show them, where cells say that it may stand for
// the finest one: of what is moved into the finest one's range, none is left out.
TEST(HiddenRanges, LeaveOutNothingOfALevelThatStandsForAnother)
{
  constexpr glm::i64vec3 dims(128, 128, 128);
  const auto layers = [](const glm::vec3& u) {
    const int z = static_cast<int>(u.z * 128) % 64;
    return z >= 30 && z < 37 ? 0.7f : 0.1f;
  };
  inr::Frame frame = Oblique(glm::dvec3(dims), 24);
  frame.unitDistance = 3;
  frame.sampleDistance = 0.5;
  frame.errorTolerance = 10;
  inr::Image pictures[2];
  inr::FrameStatistics statistics;
  for (const int all : {0, 1}) {
    inr::RendererOptions options;
    options.cache = Options(inr::CachePrecision::Float32, 17);
    inr::Renderer renderer(std::make_shared<FieldEvaluator>(layers), VolumeOf(dims),
                           CellsOf(layers, dims, 4), options);
    renderer.setTransferFunction(Shell(all != 0 ? Invisible : 0));
    statistics = renderer.render(frame, pictures[all]);
  }
  EXPECT_GT(statistics.levels.coarsest, 0);
  ExpectSame(pictures[0], pictures[1]);
}

// Of a file that says what is not so: its ranges count, as they do for all samples, and how often
// is told.
TEST(HiddenRanges, OfForeignFilesHideNothing)
{
  const auto field = [](const glm::vec3& u) { return 0.55f + 0.01f * u.x; };
  inr::MacroCells cells = CellsOf(field, Cube, 8);
  std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0.62f, 0.7f});
  cells.provenance = inr::MacroCellProvenance::File;
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Bits16, 17);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(Cube), cells, options);
  renderer.setTransferFunction(Shell(0));
  const inr::Frame frame = Oblique(glm::dvec3(Cube), 32);
  inr::Image picture;
  const inr::FrameStatistics statistics = renderer.render(frame, picture);
  EXPECT_GT(statistics.clamped, statistics.samples / 2);
  EXPECT_GT(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 0.5f);
}

/// Renders twice: of the second picture all bricks are there.
void ExpectTheSameCounts(const inr::RendererOptions& options, const inr::TransferFunction& colours,
                         const inr::Frame& frame)
{
  inr::MacroCells cells = CellsOf(Waves, Cube, 8);
  std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0.5f, 0.6f});
  cells.provenance = inr::MacroCellProvenance::File;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(Waves), VolumeOf(Cube), cells, options);
  renderer.setTransferFunction(colours);
  inr::Image picture;
  inr::Image samples[2]; // and their levels
  const inr::FrameStatistics waiting = renderer.render(frame, picture, nullptr, {}, &samples[0]);
  const inr::FrameStatistics again = renderer.render(frame, picture, nullptr, {}, &samples[1]);
  EXPECT_GT(waiting.work.bricks.bricks, 50);
  EXPECT_EQ(again.work.bricks.bricks, 0);
  EXPECT_GT(again.clamped, 400);
  EXPECT_EQ(waiting.clamped, again.clamped);
  EXPECT_EQ(waiting.samples, again.samples);
  EXPECT_EQ(waiting.hidden, again.hidden);
  // It walks once more through the cells that it went back by.
  EXPECT_EQ(waiting.work.cells > again.work.cells, frame.shading.has_value());
  EXPECT_GE(waiting.work.cells, again.work.cells);
  EXPECT_GT(again.levels.coarsest, 0);
  EXPECT_EQ(samples[0].pixels, samples[1].pixels);
}

TEST(HiddenRanges, ASampleIsCountedOnceWhereItsRayGoesBack)
{
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Bits16, 8);
  inr::Frame frame = Oblique(glm::dvec3(Cube), 24);
  frame.levelOfDetailScale = 0.7; // some of the next level
  ExpectTheSameCounts(options, UniformMedium(0.001f), frame);
  frame.shading = inr::Material{0.2f, 0.6f, 0.4f, 8.0f};
  ExpectTheSameCounts(options, UniformMedium(0.001f), frame);
}

} // namespace test::hidden_ranges
