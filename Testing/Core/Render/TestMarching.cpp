// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace test::marching {

/// A ball of radius 0.3 with a soft rim.
float Ball(const glm::vec3& u)
{
  const glm::vec3 d = u - 0.5f;
  const float radius = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  return std::fmin(1.0f, std::fmax(0.0f, (0.35f - radius) / 0.1f));
}

/// Exact ranges of Ball, from a dense sampling of every cell with an apron.
inr::MacroCells BallCells(const glm::i64vec3& dims, int edge)
{
  inr::MacroCells cells = inr::MakeMacroCells(dims, edge);
  const glm::i64vec3 fine = dims * std::int64_t{2};
  for (std::int64_t z = 0; z < fine.z; ++z) {
    for (std::int64_t y = 0; y < fine.y; ++y) {
      for (std::int64_t x = 0; x < fine.x; ++x) {
        const glm::dvec3 u = (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(fine);
        const float value = Ball(glm::vec3(u));
        for (std::int64_t k = 0; k < cells.dims.x * cells.dims.y * cells.dims.z; ++k) {
          const glm::dvec3 low =
              cells.spacing * glm::dvec3(k % cells.dims.x, k / cells.dims.x % cells.dims.y,
                                         k / cells.dims.x / cells.dims.y);
          const glm::dvec3 apron = 1.0 / glm::dvec3(dims);
          if (glm::all(glm::greaterThanEqual(u, low - apron)) &&
              glm::all(glm::lessThanEqual(u, low + cells.spacing + apron))) {
            cells.ranges[static_cast<std::size_t>(k)].extend(value);
          }
        }
      }
    }
  }
  return cells;
}

inr::Frame Diagonal(int size)
{
  const glm::dmat4 view =
      glm::lookAt(glm::dvec3(70, 45, 90), glm::dvec3(16, 16, 16), glm::dvec3(0, 1, 0));
  inr::Frame frame;
  frame.width = size;
  frame.height = size;
  frame.clipToWorld = glm::inverse(glm::perspective(0.4, 1.0, 10.0, 300.0) * view);
  return frame;
}

TEST(Marching, SkippingEmptySpaceDoesNotChangeThePicture)
{
  const glm::i64vec3 dims(33, 33, 33);
  inr::Renderer everywhere = FieldRenderer(dims, Ball);
  inr::Renderer skipping = FieldRenderer(dims, Ball, BallCells(dims, 8));
  for (inr::Renderer* renderer : {&everywhere, &skipping}) {
    renderer->setTransferFunction(OpacityRamp(0.5f));
  }
  inr::Image all;
  inr::Image skipped;
  const auto allSamples = everywhere.render(Diagonal(48), all).samples;
  const auto fewSamples = skipping.render(Diagonal(48), skipped).samples;
  EXPECT_LT(fewSamples, 0.9 * static_cast<double>(allSamples));
  for (std::size_t k = 0; k < all.pixels.size(); ++k) {
    ASSERT_NEAR(all.pixels[k], skipped.pixels[k], 1e-5f);
  }
}

TEST(Marching, ThreadsDoNotChangeAPixel)
{
  const auto model = RandomModel(SmallDescription());
  model->volume.dims = {33, 33, 33};
  std::vector<inr::Image> images;
  for (const int threads : {1, 2, 5}) {
    inr::RendererOptions options;
    options.threads = threads;
    inr::Renderer renderer(model, options);
    renderer.setTransferFunction(OpacityRamp(0.2f));
    images.push_back(Render(renderer, Diagonal(50)));
  }
  EXPECT_EQ(images[0].pixels, images[1].pixels);
  EXPECT_EQ(images[0].pixels, images[2].pixels);
}

TEST(Marching, OutliersAreClampedToTheirCellAndCounted)
{
  inr::MacroCells cells = inr::MakeMacroCells({17, 17, 17}, 16);
  for (inr::ValueRange& range : cells.ranges) {
    range = {0.25f, 0.5f};
  }
  inr::Renderer outlying = FieldRenderer(
      {17, 17, 17}, [](const glm::vec3&) { return 7.0f; }, cells);
  inr::Renderer clamped = FieldRenderer(
      {17, 17, 17}, [](const glm::vec3&) { return 0.5f; }, cells);
  outlying.setTransferFunction(OpacityRamp(0.5f));
  clamped.setTransferFunction(OpacityRamp(0.5f));
  const inr::Frame frame = ParallelFrame(4, {1, 1}, {15, 15}, -5, 30);
  inr::Image image;
  const inr::FrameStatistics statistics = outlying.render(frame, image);
  EXPECT_EQ(statistics.clamped, statistics.samples);
  EXPECT_GT(statistics.samples, 0);
  EXPECT_EQ(image.pixels, Render(clamped, frame).pixels);
}

TEST(Marching, OpaqueRaysEndEarly)
{
  inr::Renderer thin = FieldRenderer({65, 65, 65}, [](const glm::vec3&) { return 0.5f; });
  inr::Renderer dense = FieldRenderer({65, 65, 65}, [](const glm::vec3&) { return 0.5f; });
  thin.setTransferFunction(UniformMedium(0.1f));
  dense.setTransferFunction(UniformMedium(0.95f));
  const inr::Frame frame = ParallelFrame(4, {1, 1}, {63, 63}, -5, 80);
  inr::Image image;
  const std::int64_t samplesOfThin = thin.render(frame, image).samples;
  EXPECT_LT(10 * dense.render(frame, image).samples, samplesOfThin);
  EXPECT_GE(image.pixel(1, 1)[3], 0.999f);
}

TEST(Marching, FaintMediaTakeFewerSamplesForTheSamePicture)
{
  inr::Renderer renderer = FieldRenderer({65, 65, 65}, Ball);
  inr::Image image;
  const auto samplesFor = [&](float opacity) {
    renderer.setTransferFunction(OpacityRamp(opacity));
    return renderer.render(Diagonal(32), image).samples;
  };
  EXPECT_LT(3 * samplesFor(0.001f), samplesFor(0.1f));
}

TEST(Marching, MajorantsAreRebuiltOnceForAChange)
{
  inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball);
  renderer.setTransferFunction(OpacityRamp(0.5f));
  renderer.setTransferFunction(OpacityRamp(0.5f));
  Render(renderer, Diagonal(8));
  EXPECT_EQ(renderer.colorsVersion(), 1);
  renderer.setTransferFunction(OpacityRamp(0.6f));
  EXPECT_EQ(renderer.colorsVersion(), 2);
}

TEST(Marching, DepthIsWhereOpacityReachesOneHalf)
{
  inr::Renderer renderer = FieldRenderer({33, 33, 33}, [](const glm::vec3&) { return 0.5f; });
  renderer.setTransferFunction(UniformMedium(0.1f));
  inr::Frame frame = ParallelFrame(4, {-40, -40}, {40, 40}, -10, 50);
  frame.sampleDistance = 0.1;
  inr::Image image;
  inr::Image depth;
  renderer.render(frame, image, &depth);
  const double half = std::log(0.5) / std::log(0.9); // voxels from z = 0
  EXPECT_NEAR(*depth.pixel(2, 2), (10 + half) / 60, 0.2 / 60);
  EXPECT_EQ(*depth.pixel(0, 0), 1.0f);
}

TEST(Marching, CanBeStopped)
{
  inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball);
  renderer.setTransferFunction(OpacityRamp(0.5f));
  inr::Image image;
  std::atomic<int> tiles{0};
  EXPECT_THROW(renderer.render(Diagonal(200), image, nullptr, [&] { return ++tiles < 5; }),
               inr::Error);
  EXPECT_LT(tiles, 10);
}

TEST(Marching, ARefusedTransferFunctionLeavesTheOneBefore)
{
  inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball);
  renderer.setTransferFunction(OpacityRamp(0.5f));
  const inr::Image before = Render(renderer, Diagonal(8));
  inr::TransferFunction flat = OpacityRamp(0.5f);
  flat.high = flat.low;
  EXPECT_THROW(renderer.setTransferFunction(flat), inr::Error);
  EXPECT_EQ(Render(renderer, Diagonal(8)).pixels, before.pixels);
  renderer.setTransferFunction(OpacityRamp(0.5f));
  EXPECT_EQ(Render(renderer, Diagonal(8)).pixels, before.pixels);
}

TEST(Marching, NeedsAFieldAndAVolume)
{
  const inr::ModelPointer none;
  EXPECT_THROW(inr::Renderer{none}, inr::Error);
  const glm::i64vec3 dims(9, 9, 9);
  const auto ball = std::make_shared<FieldEvaluator>(Ball);
  EXPECT_THROW(inr::Renderer(nullptr, VolumeOf(dims), {}), inr::Error);
  EXPECT_THROW(inr::Renderer(ball, VolumeOf({9, 0, 9}), {}), inr::Error);
  inr::VolumeInfo unknown = VolumeOf(dims);
  unknown.low = std::nan("");
  EXPECT_THROW(inr::Renderer(ball, unknown, {}), inr::Error);
  const inr::MacroCells cells = inr::MakeMacroCells(dims, 4);
  EXPECT_NO_THROW(inr::Renderer(ball, VolumeOf(dims), cells));
  const auto refuses = [&](const inr::MacroCells& wrong) {
    EXPECT_THROW(inr::Renderer(ball, VolumeOf(dims), wrong), inr::Error);
  };
  inr::MacroCells wrong = cells;
  wrong.ranges.pop_back();
  refuses(wrong);
  for (const std::size_t more : {1, 3}) { // 3 x 3 x 3 cells
    wrong = cells;
    wrong.ranges.resize(cells.ranges.size() + more);
    refuses(wrong);
  }
  wrong = cells;
  ++wrong.dims.z;
  refuses(wrong);
  wrong = cells;
  wrong.spacing.y = 0;
  refuses(wrong);
  wrong = cells;
  wrong.dims = glm::i64vec3(std::int64_t{1} << 32); // their product is 0 in 64 bits
  refuses(wrong);
}

TEST(Marching, NeedsAnEndOfTheView)
{
  inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball);
  renderer.setTransferFunction(OpacityRamp(0.5f));
  inr::Frame frame = Diagonal(8);
  const glm::dmat4 toCamera = glm::lookAt(glm::dvec3(70, 45, 90), glm::dvec3(4), {0, 1, 0});
  inr::Image image;
  frame.clipToWorld = glm::inverse(glm::infinitePerspective(0.05, 1.0, 10.0) * toCamera);
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
  frame.clipToWorld = glm::inverse(glm::perspective(0.05, 1.0, 1e-3, 1e12) * toCamera);
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
  frame.clipToWorld = glm::inverse(glm::perspective(0.05, 1.0, 1.0, 1e11) * toCamera);
  const inr::Image far = Render(renderer, frame);
  frame.clipToWorld = glm::inverse(glm::perspective(0.05, 1.0, 1.0, 1e3) * toCamera);
  const inr::Image near = Render(renderer, frame);
  ASSERT_GT(near.pixel(4, 4)[3], 0.1f);
  for (std::size_t k = 0; k < near.pixels.size(); ++k) {
    EXPECT_NEAR(far.pixels[k], near.pixels[k], 0.01) << k;
  }
}

TEST(Marching, KnowsItsModes)
{
  inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball);
  renderer.setTransferFunction(OpacityRamp(0.5f));
  inr::Image image;
  inr::Frame frame = Diagonal(8);
  frame.mode = static_cast<inr::RenderMode>(9);
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
  frame = Diagonal(8);
  frame.blending.mode = static_cast<inr::BlendMode>(77);
  EXPECT_THROW(renderer.render(frame, image), inr::Error);
}

/// Whoever is asked whether to go on, can stop the picture, but not have it drawn otherwise.
TEST(Marching, CannotBeChangedWhileItDraws)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball, {}, 1, cached);
    renderer.setTransferFunction(OpacityRamp(0.5f));
    const inr::Frame frame = Diagonal(8);
    const inr::Image expected = Render(renderer, frame);
    inr::Image image;
    int refused = 0;
    const auto change = [&] {
      inr::Image other;
      EXPECT_THROW(renderer.setTransferFunction(OpacityRamp(0.1f)), inr::Error);
      EXPECT_THROW(renderer.render(frame, other), inr::Error);
      ++refused;
      return true;
    };
    renderer.render(frame, image, nullptr, change);
    EXPECT_GT(refused, 0);
    EXPECT_EQ(image.pixels, expected.pixels);
    EXPECT_THROW(renderer.render(frame, image, nullptr, [] { return false; }), inr::Error);
    EXPECT_EQ(Render(renderer, frame).pixels, expected.pixels) << "after one that was stopped";
  }
}

TEST(Marching, NeedsATransferFunction)
{
  inr::Renderer renderer = FieldRenderer({9, 9, 9}, Ball);
  inr::Image image;
  EXPECT_THROW(renderer.render(Diagonal(8), image), inr::Error);
}

} // namespace test::marching
