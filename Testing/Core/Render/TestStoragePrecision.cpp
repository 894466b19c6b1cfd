// SPDX-License-Identifier: BSD-3-Clause
//
// How a cache keeps voxels for pictures with a tolerance.
#include "Core/Error.h"
#include "Core/Render/Tolerance/StoragePrecision.h"
#include "Testing/Core/Image/PixelDifferences.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <limits>

namespace test::storage_precision {

constexpr glm::i64vec3 Cube(72, 72, 72);

inr::Frame FrameOf(double tolerance)
{
  inr::Frame frame = Oblique(glm::dvec3(Cube), 64);
  frame.unitDistance = 2;
  frame.errorTolerance = tolerance;
  return frame;
}

/// All of its slopes within `width` of the values, around the middle.
inr::TransferFunction RampOf(double width, double opacity)
{
  inr::TransferFunction function;
  function.low = 0.5 - width / 2;
  function.high = 0.5 + width / 2;
  for (int k = 0; k < 256; ++k) {
    const float x = static_cast<float>(k) / 255;
    function.table.emplace_back(x, 1 - x, 0.2f, static_cast<float>(opacity) * (0.2f + 0.8f * x));
  }
  function.below = function.table.front();
  function.above = function.table.back();
  return function;
}

inr::CachePrecision Chosen(const inr::Frame& frame, const inr::TransferFunction& colors)
{
  return inr::PrecisionWithin(frame, colors, VolumeOf(Cube), true);
}

/// Waves as high as the colours are wide; in every brick one voxel that makes its quanta coarse.
float WavesBesideSpikes(const glm::vec3& u, double width)
{
  const glm::ivec3 voxel(u * 72.0f);
  const bool isSpike = voxel.x % 24 == 5 && voxel.y % 24 == 5 && voxel.z % 24 == 5;
  const float wave = std::sin(5 * u.x + 2 * u.y) * std::cos(4 * u.z);
  return isSpike ? 1.0f : 0.5f + 0.5f * static_cast<float>(width) * wave;
}

inr::Image Drawn(double width, const inr::TransferFunction& colors, const inr::Frame& frame,
                 inr::CachePrecision precision)
{
  inr::RendererOptions options;
  options.cache = Options(precision, 40);
  const auto field = [=](const glm::vec3& u) { return WavesBesideSpikes(u, width); };
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(Cube),
                         CellsOf(field, Cube), options);
  renderer.setTransferFunction(colors);
  return Draw(renderer, frame).picture;
}

TEST(StoragePrecision, KeepsToAToleranceWhateverTheColoursAreAbout)
{
  int rounded = 0;
  double worstOfRounded = 0;
  for (const double width : {1.0, 1e-2, 3e-5, 3e-6}) {
    const inr::TransferFunction colors = RampOf(width, 0.3);
    const inr::Image exact = Drawn(width, colors, FrameOf(0), inr::CachePrecision::Float32);
    const inr::Image coarse = Drawn(width, colors, FrameOf(0), inr::CachePrecision::Bits16);
    const double change = PixelDifferences(coarse, exact).back();
    for (const double tolerance : {1.0, 16.0}) {
      const inr::Frame frame = FrameOf(tolerance);
      const inr::CachePrecision precision = Chosen(frame, colors);
      const auto off = PixelDifferences(Drawn(width, colors, frame, precision), exact);
      EXPECT_GE(ShareWithin(tolerance, off), 0.999) << width << " with " << tolerance;
      if (precision == inr::CachePrecision::Bits16) {
        ++rounded;
        EXPECT_LE(change, tolerance / 8) << width << " with " << tolerance;
      }
    }
    worstOfRounded = std::max(worstOfRounded, change);
  }
  EXPECT_GE(rounded, 1);
  EXPECT_GT(worstOfRounded, 16); // what 16 bits would do to the narrowest
}

TEST(StoragePrecision, FollowsWhatAPictureIsMadeOf)
{
  constexpr auto rounded = inr::CachePrecision::Bits16;
  constexpr auto exact = inr::CachePrecision::Float32;
  const inr::TransferFunction wide = RampOf(1.0, 0.3);
  inr::Frame frame = FrameOf(16);
  ASSERT_EQ(Chosen(frame, wide), rounded);
  EXPECT_EQ(Chosen(FrameOf(0.01), wide), exact);
  EXPECT_EQ(Chosen(FrameOf(0), wide), exact);
  EXPECT_EQ(Chosen(frame, RampOf(1e-3, 0.3)), exact);
  EXPECT_EQ(Chosen(frame, RampOf(1e-3, 1e-4)), rounded); // hardly seen
  inr::TransferFunction jumping = RampOf(0.5, 0.3);
  jumping.above = glm::vec4(0);
  EXPECT_EQ(Chosen(frame, jumping), exact);
  EXPECT_EQ(Chosen(frame, RampOf(1.0, 1.0)), exact);
  EXPECT_EQ(inr::PrecisionWithin(frame, wide, VolumeOf(Cube * std::int64_t{1000}), true), exact);

  inr::Frame other = frame;
  other.unitDistance = 0.01; // so much more opaque
  EXPECT_EQ(Chosen(other, wide), exact);
  other.worldToIndex = glm::scale(glm::dmat4(1.0), glm::dvec3(100)); // and so much smaller
  EXPECT_EQ(Chosen(other, wide), rounded);
  other = frame;
  other.shading = inr::Material{};
  EXPECT_EQ(Chosen(other, wide), exact);
  other = frame;
  other.sampleDistance = 2; // and the rest that is drawn as with a tolerance of 0
  EXPECT_EQ(Chosen(other, wide), exact);
  other = frame;
  other.cropping = inr::Cropping{glm::dvec3(20), glm::dvec3(50), 1u << 13};
  EXPECT_EQ(Chosen(other, wide), rounded); // a box
  other.cropping->flags = 1u << 13 | 1u << 26;
  EXPECT_EQ(Chosen(other, wide), exact);
  EXPECT_EQ(inr::PrecisionWithin(frame, wide, VolumeOf(Cube), false), exact);
  other = frame;
  other.blending.mode = inr::BlendMode::MaximumIntensity;
  EXPECT_EQ(Chosen(other, wide), exact);
  other = frame;
  other.mode = inr::RenderMode::PathTracing;
  EXPECT_EQ(Chosen(other, wide), exact);
  other = frame;
  other.errorTolerance = std::numeric_limits<double>::quiet_NaN(); // which rendering will refuse
  EXPECT_EQ(Chosen(other, wide), exact);
  EXPECT_THROW(Chosen(frame, inr::TransferFunction()), inr::Error);
}

} // namespace test::storage_precision
