// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/LevelOfDetail.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

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

TEST(LevelOfDetail, FollowsTheFootprintWithoutSteps)
{
  inr::LevelOfDetail detail(Spreading(0.3, 0.01), 1.0, 13);
  double last = 0;
  for (double t = 0; t < 3000; t += 7) {
    const double footprint = 0.3 + 0.01 * t;
    const double level = MeanLevel(detail, t);
    // Linear between powers of two where log2 bends: never further off than 0.09.
    EXPECT_NEAR(level, std::max(0.0, std::log2(footprint)), 0.09 + 0.015) << t;
    EXPECT_GT(level, last - 0.03);
    last = level;
  }
}

TEST(LevelOfDetail, MovesBothWaysAndStaysWithinTheLevels)
{
  inr::LevelOfDetail narrowing(Spreading(1000, -1), 1.0, 4);
  EXPECT_EQ(MeanLevel(narrowing, 0), 3);
  EXPECT_NEAR(MeanLevel(narrowing, 997), std::log2(3.0), 0.1);
  EXPECT_EQ(MeanLevel(narrowing, 999.5), 0);
  inr::LevelOfDetail full(Spreading(1000, 1), 0.0, 4);
  EXPECT_EQ(MeanLevel(full, 50), 0);
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

} // namespace
