// SPDX-License-Identifier: BSD-3-Clause
//
// Very many samples, and pictures of extreme shapes.
#include "Core/Error.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/PathScene.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <limits>

namespace test::extreme_sampling {

TEST(ExtremeSampling, AMillionPicturesKeepTheirMean)
{
  constexpr int count = 1000000;
  inr::Accumulator accumulator;
  accumulator.reset(1, 1);
  inr::Image sample(1, 1, 4);
  long double sums[4] = {};
  std::uint64_t bits = 1;
  for (int k = 0; k < count; ++k) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    const float random = static_cast<float>(bits >> 40) * 0x1p-24f;
    sample.pixels = {random, 1e-7f * random, k == 0 ? 1e9f : random, 1.0f / 3};
    accumulator.add(sample);
    for (std::size_t channel = 0; channel < 4; ++channel) {
      sums[channel] += sample.pixels[channel];
    }
  }
  inr::Image mean;
  accumulator.mean(mean);
  EXPECT_EQ(accumulator.samples(), count);
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const auto truth = static_cast<double>(sums[channel] / count);
    EXPECT_NEAR(mean.pixels[channel], truth, 1e-7 * truth) << channel; // as floats have it
  }
}

inr::Frame Paths(int samplesPerPixel)
{
  inr::Frame frame = ParallelFrame(1, {4, 4}, {12, 12}, -10, 50);
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = samplesPerPixel;
  frame.unitDistance = 16;
  return frame;
}

TEST(ExtremeSampling, AHundredThousandPathsThroughAPixel)
{
  constexpr int paths = 100000;
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer({17, 17, 17}, Constant, {}, 1, cached);
    renderer.setTransferFunction(UniformMedium(0.3f));
    inr::Image image;
    const inr::FrameStatistics statistics = renderer.render(Paths(paths), image);
    EXPECT_TRUE(statistics.complete);
    EXPECT_EQ(statistics.paths, paths);
    EXPECT_LT(std::abs(image.pixels[3] - 0.3), Unlikely * std::sqrt(0.3 * 0.7 / paths));
  }
}

TEST(ExtremeSampling, OneAndAllNumbersOfPathsEnd)
{
  inr::RendererOptions options;
  options.threads = 1;
  options.deterministic = true; // a round for each call
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(Constant), VolumeOf({17, 17, 17}), {},
                         options);
  renderer.setTransferFunction(UniformMedium(0.3f));
  inr::Image image;
  EXPECT_TRUE(renderer.render(Paths(1), image).complete);
  inr::Frame frame = Paths(std::numeric_limits<int>::max());
  frame.timeLimit = 1;
  frame.frameIndex = std::numeric_limits<std::uint64_t>::max();
  frame.seed = std::numeric_limits<std::uint64_t>::max();
  for (int k = 1; k <= 3; ++k) {
    const inr::FrameStatistics statistics = renderer.render(frame, image);
    EXPECT_FALSE(statistics.complete);
    EXPECT_EQ(statistics.paths, k);
  }
}

/// Along z, with 32 samples to the unit of opacity: as many as a ray has through the longest
/// volume.
TEST(ExtremeSampling, MillionsOfSamplesOnARayAddUp)
{
  const glm::i64vec3 dims(2, 2, 131072);
  for (const double step : {1.0, 0.125}) {
    for (const bool cached : {false, true}) {
      inr::Renderer renderer = FieldRenderer(dims, Constant, {}, 1, cached);
      renderer.setTransferFunction(UniformMedium(0.5f));
      inr::Frame frame = ParallelFrame(1, {0, 0}, {1, 1}, -10, 2e5);
      frame.unitDistance = 131071;
      frame.sampleDistance = step;
      frame.levelOfDetailScale = 0;
      frame.adaptiveSampling = false;
      inr::Image image;
      const inr::FrameStatistics statistics = renderer.render(frame, image);
      EXPECT_NEAR(static_cast<double>(statistics.samples), 131071 / step, 2);
      EXPECT_NEAR(image.pixels[3], 0.5, 1e-4) << step << " " << cached;
      EXPECT_NEAR(image.pixels[0], 0.5, 1e-4) << step << " " << cached;
    }
  }
}

/// Pixels of a picture whose plane shows x and y from -16 to 48 of a volume from 0 to 32.
void ExpectTheSquare(int width, int height)
{
  inr::Renderer renderer = FieldRenderer({33, 33, 33}, Constant, {}, 2, true);
  renderer.setTransferFunction(UniformMedium(0.5f));
  inr::Frame frame = ParallelFrame(1, {-16, -16}, {48, 48}, -10, 50);
  frame.width = width;
  frame.height = height;
  frame.unitDistance = 32;
  inr::Image image;
  inr::Image depth;
  renderer.render(frame, image, &depth);
  ASSERT_EQ(image.width, width);
  ASSERT_EQ(image.height, height);
  std::int64_t wrong = 0;
  const auto inside = [](int k, int pixels) {
    const double place = -16 + 64 * (k + 0.5) / pixels;
    return place >= 0 && place <= 32;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double truth = inside(x, width) && inside(y, height) ? 0.5 : 0.0;
      wrong += std::abs(image.pixel(x, y)[3] - truth) < 1e-4 ? 0 : 1;
    }
  }
  EXPECT_EQ(wrong, 0) << width << " x " << height;
}

TEST(ExtremeSampling, PicturesOfAnyShape)
{
  ExpectTheSquare(1, 1);
  ExpectTheSquare(1, 10000);
  ExpectTheSquare(10000, 1);
  ExpectTheSquare(3, 2001);
  ExpectTheSquare(16384, 64);
}

TEST(ExtremeSampling, PicturesThatAreTooLargeAreRefused)
{
  inr::Renderer renderer = FieldRenderer({3, 3, 3}, Constant);
  renderer.setTransferFunction(UniformMedium(0.5f));
  for (const glm::ivec2& size : {glm::ivec2(16385, 16384), glm::ivec2(1 << 30, 1 << 30),
                                 glm::ivec2(std::numeric_limits<int>::max())}) {
    inr::Frame frame = ParallelFrame(1, {0, 0}, {1, 1}, -1, 4);
    frame.width = size.x;
    frame.height = size.y;
    inr::Image image;
    EXPECT_THROW(renderer.render(frame, image), inr::Error);
  }
}

// 16384 x 16384 pixels as pictures of 1024 x 1024, of which the one with a corner of the volume and
// one inside are looked at: pixels are where they are in the whole.
TEST(ExtremeSampling, HugePicturesAreMadeOfTiles)
{
  constexpr int tile = 1024;
  constexpr int whole = 16384;
  inr::Renderer renderer = FieldRenderer({33, 33, 33}, Constant, {}, 2, true);
  renderer.setTransferFunction(UniformMedium(0.5f));
  const double pixel = 64.0 / whole;
  for (const int first : {whole / 4 - tile / 2, whole / 2}) {
    const double low = -16.0004 + first * pixel;
    inr::Frame frame =
        ParallelFrame(tile, glm::dvec2(low), glm::dvec2(low + tile * pixel), -10, 50);
    frame.width = frame.height = tile;
    frame.unitDistance = 32;
    frame.sampleDistance = 32;
    const inr::Image image = Render(renderer, frame);
    for (int k = 0; k < tile; k += 7) {
      const double place = low + (k + 0.5) * pixel;
      EXPECT_NEAR(image.pixel(k, k)[3], place >= 0 ? 0.5 : 0.0, 1e-4) << k;
    }
  }
}

} // namespace test::extreme_sampling
