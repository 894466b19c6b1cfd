// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/ColorSensitivity.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::color_sensitivity {

/// What a step at a value leaves of light `behind`, in double; alpha last.
glm::dvec4 Passed(const inr::ColorLookup& colors, float value, double stepLength, double behind)
{
  const glm::vec4 entry = colors.at(value);
  const double opacity = 1.0 - std::pow(1.0 - static_cast<double>(entry.w), stepLength);
  return {glm::dvec3(entry) * opacity + (1.0 - opacity) * behind, opacity};
}

/// A table with a peak, flat parts and changing colours.
inr::TransferFunction Peak()
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    const float peak = std::max(0.0f, 1 - std::abs(x - 0.6f) / 0.2f);
    function.table.emplace_back(x < 0.5f ? 0.2f : x, 0.5f, 1 - x * x, 0.4f * peak);
  }
  return function;
}

void ExpectBounds(const inr::TransferFunction& function, double brightest)
{
  const inr::ColorTable table(function, VolumeOf(glm::i64vec3(8)));
  for (const double stepLength : {0.3, 1.0, 4.0}) {
    const inr::ColorSensitivity sensitivity(table.lookup(), stepLength);
    for (const inr::ValueRange& range : {inr::ValueRange{0.1f, 0.3f},
                                         {0.35f, 0.55f},
                                         {0.5f, 0.75f},
                                         {0.0f, 1.0f},
                                         {0.7f, 0.71f}}) {
      const inr::ColorSensitivity::Slopes slopes = sensitivity.slopes(range);
      double steepest = 0;
      constexpr int parts = 400;
      for (int k = 0; k < parts; ++k) {
        const float width = (range.high - range.low) / parts;
        const float low = range.low + static_cast<float>(k) * width;
        for (const double behind : {0.0, 0.4 * brightest, 1.0, brightest}) {
          const glm::dvec4 change = (Passed(table.lookup(), low + width, stepLength, behind) -
                                     Passed(table.lookup(), low, stepLength, behind)) /
                                    static_cast<double>(width);
          for (int channel = 0; channel < 4; ++channel) {
            steepest = std::max(steepest, std::abs(change[channel]));
          }
        }
      }
      const double bound = slopes.middle + slopes.half;
      EXPECT_LE(steepest, 1.02 * bound + 1e-4) << range.low;
      EXPECT_GE(steepest, 0.4 * bound - 1e-4) << range.low; // and is no wild guess
    }
  }
}

TEST(ColorSensitivity, BoundsWhatAnyChangeInARangeDoes)
{
  ExpectBounds(Peak(), 1);
  inr::TransferFunction bright = Peak();
  for (glm::vec4& entry : bright.table) {
    entry.y *= 30;
  }
  ExpectBounds(bright, 15);
}

/// Where opacity comes to 1, that of half a unit rises without limit, and that of two ends flat.
TEST(ColorSensitivity, KnowsOpacitiesOfOne)
{
  inr::TransferFunction function;
  for (int k = 0; k < 65; ++k) {
    const float x = static_cast<float>(k) / 64;
    function.table.emplace_back(x, 1 - x, 0, 1 - std::abs(2 * x - 1)); // 1 in the middle
  }
  const inr::ColorTable table(function, VolumeOf(glm::i64vec3(8)));
  for (const inr::ValueRange& middle : {inr::ValueRange{0.49f, 0.495f}, {0.505f, 0.51f}}) {
    const auto of = [&](double stepLength) {
      return inr::ColorSensitivity(table.lookup(), stepLength).slopes(middle);
    };
    EXPECT_TRUE(std::isinf(of(0.5).half));
    EXPECT_NEAR(of(1.0).middle + of(1.0).half, 2.5, 0.6); // opacity 2, and colours beside it
    EXPECT_LT(of(2.0).middle + of(2.0).half, 1.3);
    EXPECT_FALSE(std::isinf(inr::ColorSensitivity(table.lookup(), 0.5).slopes({0.1f, 0.4f}).half));
  }
}

TEST(ColorSensitivity, KnowsHowMuchIsHiddenAtLeast)
{
  inr::TransferFunction ramp;
  for (int k = 0; k < 65; ++k) {
    ramp.table.emplace_back(1, 1, 1, 0.5f * static_cast<float>(k) / 64);
  }
  const inr::ColorTable table(ramp, VolumeOf(glm::i64vec3(8)));
  const inr::ColorSensitivity sensitivity(table.lookup(), 3.0);
  const float depth = sensitivity.slopes({0.6f, 0.9f}).depth;
  EXPECT_LE(depth, -3 * std::log(1 - 0.5 * 0.6) * 1.001);
  EXPECT_GE(depth, -3 * std::log(1 - 0.5 * 0.6) * 0.9); // an entry's width less
  EXPECT_LT(sensitivity.slopes({0.0f, 1.0f}).depth, 1e-6);
}

TEST(ColorSensitivity, IsAllMiddleWhereColoursAreLinear)
{
  inr::TransferFunction ramp = OpacityRamp(0.01f); // so faint that a step is linear, too
  const inr::ColorTable table(ramp, VolumeOf(glm::i64vec3(8)));
  const inr::ColorSensitivity::Slopes slopes =
      inr::ColorSensitivity(table.lookup(), 1.0).slopes({0.2f, 0.9f});
  EXPECT_NEAR(slopes.middle, 0.01, 1e-4);
  EXPECT_NEAR(slopes.half, 0, 1e-6);
}

TEST(ColorSensitivity, KnowsWhereTheTableEnds)
{
  inr::TransferFunction function = UniformMedium(0.1f);
  function.low = 0.25;
  function.high = 0.75;
  function.above = function.table.back();
  const inr::ColorTable table(function, VolumeOf(glm::i64vec3(8)));
  const inr::ColorSensitivity sensitivity(table.lookup(), 1.0);
  EXPECT_TRUE(std::isinf(sensitivity.slopes({0.2f, 0.3f}).half)); // to nothing below
  EXPECT_EQ(sensitivity.slopes({0.3f, 0.9f}).half, 0.0f);         // goes on above
  EXPECT_EQ(sensitivity.slopes({0.0f, 0.2f}).half, 0.0f);
  EXPECT_EQ(sensitivity.slopes({}).half, 0.0f);
}

TEST(ColorSensitivity, FollowsALogarithm)
{
  inr::TransferFunction function = OpacityRamp(0.2f);
  function.low = 1;
  function.high = 1000;
  function.logarithmic = true;
  inr::VolumeInfo volume = VolumeOf(glm::i64vec3(8));
  volume.low = 0;
  volume.high = 1000;
  const inr::ColorTable table(function, volume);
  const inr::ColorSensitivity sensitivity(table.lookup(), 1.0);
  // d opacity / d y = 0.2 / ln(1000) / value * 1000
  const inr::ColorSensitivity::Slopes slopes = sensitivity.slopes({0.1f, 0.5f});
  const double steepest = 0.2 / std::log(1000.0) / 100 * 1000;
  EXPECT_GE(slopes.middle + slopes.half, 0.999 * steepest);
  EXPECT_LE(slopes.middle + slopes.half, 2.001 * steepest);
  EXPECT_TRUE(std::isinf(sensitivity.slopes({0.0f, 0.5f}).half));
}

} // namespace test::color_sensitivity
