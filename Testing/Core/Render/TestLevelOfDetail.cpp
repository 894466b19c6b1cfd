// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Rays/LevelOfDetail.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::level_of_detail {

inr::Ray Spreading(double footprint, double growth)
{
  inr::Ray ray;
  ray.footprint = footprint;
  ray.footprintGrowth = growth;
  return ray;
}

/// Mean level of many dithered samples at t.
double MeanLevel(inr::LevelOfDetail& detail, double t)
{
  detail.moveTo(t);
  double sum = 0;
  constexpr int samples = 20000;
  for (int k = 0; k < samples; ++k) {
    sum += detail.dithered(3, k);
  }
  return sum / samples;
}

/// The coarsest level whose voxels are no larger than the footprint, and in the last quarter before
/// the next one's are, more and more of that.
double LevelFor(double footprint)
{
  const double level = std::floor(std::log2(std::max(1.0, footprint)));
  return level + std::max(0.0, 4 * (footprint / std::exp2(level) - 1.75));
}

TEST(LevelOfDetail, FollowsTheFootprintWithoutSteps)
{
  inr::LevelOfDetail detail(Spreading(0.3, 0.01), 1.0, 13);
  double last = 0;
  for (double t = 0; t < 3000; t += 7) {
    const double level = MeanLevel(detail, t);
    EXPECT_NEAR(level, LevelFor(0.3 + 0.01 * t), 0.015) << t;
    EXPECT_GT(level, last - 0.03);
    last = level;
  }
}

TEST(LevelOfDetail, SaysHowFarItsLevelsStay)
{
  const inr::Ray ray = Spreading(0.3, 0.01);
  for (double t = 0; t < 3000; t += 7) {
    inr::LevelOfDetail detail(ray, 1.0, 13);
    detail.moveTo(t);
    const int level = detail.level();
    const int coarsest = detail.coarsest();
    const double exit = detail.exit();
    detail.moveTo(exit - 1e-6);
    EXPECT_TRUE(detail.level() == level && detail.coarsest() == coarsest) << t;
    detail.moveTo(exit + 1e-6);
    EXPECT_FALSE(detail.level() == level && detail.coarsest() == coarsest) << t;
  }
}

TEST(LevelOfDetail, TheFractionIsLinearInT)
{
  inr::LevelOfDetail detail(Spreading(0.3, 0.01), 1.0, 13);
  for (const double t : {150.0, 157.0, 165.0, 325.0, 355.0}) { // where levels are mixed
    const double level = MeanLevel(detail, t);
    ASSERT_TRUE(detail.isDithered()) << t;
    EXPECT_NEAR(detail.level() + detail.fractionAtEntry() + detail.fractionGrowth() * t, level,
                0.015)
        << t;
  }
}

TEST(LevelOfDetail, MovesBothWaysAndStaysWithinTheLevels)
{
  inr::LevelOfDetail narrowing(Spreading(1000, -1), 1.0, 4);
  EXPECT_EQ(MeanLevel(narrowing, 0), 3);
  EXPECT_EQ(MeanLevel(narrowing, 997), 1);
  EXPECT_NEAR(MeanLevel(narrowing, 996.25), 1.5, 0.015);
  EXPECT_EQ(MeanLevel(narrowing, 999.5), 0);
  inr::LevelOfDetail full(Spreading(1000, 1), 0.0, 4);
  EXPECT_EQ(MeanLevel(full, 50), 0);
}

TEST(LevelOfDetail, StatisticsTellOfBothLevelsThatAreMixed)
{
  const glm::i64vec3 dims(65, 65, 65);
  inr::Renderer renderer = FieldRenderer(
      dims, [](const glm::vec3& u) { return 0.5f * u.z; }, {}, 2, true);
  renderer.setTransferFunction(OpacityRamp(0.001f)); // no ray becomes opaque
  for (const auto& [footprint, level] : {std::pair(1.7, 0.0), std::pair(1.8125, 0.25),
                                         std::pair(1.9375, 0.75), std::pair(2.0, 1.0)}) {
    inr::Frame frame = ParallelFrame(32, {0, 0}, glm::dvec2(32 * footprint), -10, 100);
    inr::Image rgba;
    inr::Image samples;
    const inr::FrameStatistics statistics = renderer.render(frame, rgba, nullptr, {}, &samples);
    double sum = 0;
    double count = 0;
    for (std::size_t k = 0; k < samples.pixels.size(); k += 2) {
      count += samples.pixels[k];
      sum += samples.pixels[k] * samples.pixels[k + 1];
    }
    EXPECT_EQ(count, static_cast<double>(statistics.samples));
    EXPECT_NEAR(sum / count, level, 0.01) << footprint;
    EXPECT_EQ(statistics.levels.finest, level < 1 ? 0 : 1) << footprint;
    EXPECT_EQ(statistics.levels.coarsest, level > 0 ? 1 : 0) << footprint;
  }
}

TEST(LevelOfDetail, AFootprintIsAsLargeAsAPixel)
{
  const inr::Frame frame = ParallelFrame(8, {0, 0}, {24, 24}, -10, 50); // 3 voxels a pixel
  EXPECT_NEAR(inr::RayGeometry(frame, {25, 25, 25}).ray(3, 3).footprint, 3.0, 1e-9);
  inr::Frame perspective;
  perspective.width = perspective.height = 100;
  perspective.clipToWorld = glm::inverse(
      glm::perspective(glm::radians(90.0), 1.0, 1.0, 1000.0) *
      glm::lookAt(glm::dvec3(50, 50, -100), glm::dvec3(50, 50, 0), glm::dvec3(0, 1, 0)));
  const inr::Ray ray = inr::RayGeometry(perspective, {101, 101, 101}).ray(50, 50);
  EXPECT_NEAR(ray.footprint, 2.0, 0.01); // 200 wide at a distance of 100
  EXPECT_NEAR(ray.footprint + 100 * ray.footprintGrowth, 4.0, 0.02);
}

} // namespace test::level_of_detail
