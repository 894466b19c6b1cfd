// SPDX-License-Identifier: BSD-3-Clause
//
// Levels of detail of volumes whose voxels are no cubes.
#include "Core/Random.h"
#include "Core/Render/Rays/ProjectedVoxel.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <utility>

namespace test::projected_voxel {

glm::dvec3 RandomDirection(std::uint64_t number)
{
  const double z = 2 * inr::RandomUnit(1, number) - 1;
  const double angle = glm::two_pi<double>() * inr::RandomUnit(2, number);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// The longest that the shadow of the ellipsoid reaches, looked for all around.
double LongestReach(const glm::dmat3& edges, const glm::dvec3& direction)
{
  const glm::dvec3 other = std::abs(direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(direction, other));
  const glm::dvec3 v = glm::cross(direction, u);
  double longest = 0;
  for (int k = 0; k < 5000; ++k) {
    const double angle = glm::pi<double>() * k / 5000;
    const glm::dvec3 across = std::cos(angle) * u + std::sin(angle) * v;
    longest = std::max(longest, glm::length(glm::transpose(edges) * across));
  }
  return longest;
}

TEST(ProjectedVoxel, IsAsLongAsTheShadowOfItsEllipsoid)
{
  for (std::uint64_t number = 0; number < 200; ++number) {
    glm::dmat3 edges;
    double shortest = HUGE_VAL;
    for (int axis = 0; axis < 3; ++axis) {
      edges[axis] = std::exp(4.0 * inr::RandomUnit(3, 3 * number + axis)) *
                    RandomDirection(1000 + 3 * number + axis);
      shortest = std::min(shortest, glm::length(edges[axis]));
    }
    edges[2] *= number % 4 == 0 ? 0.0 : 1.0; // a single layer
    const inr::ProjectedVoxel voxel(edges, shortest);
    const glm::dvec3 direction = RandomDirection(number);
    const double truth = std::max(LongestReach(edges, direction), shortest);
    EXPECT_NEAR(voxel.across(direction) / truth, 1, 1e-6) << number;
  }
}

TEST(ProjectedVoxel, OfACubeIsItsEdgeWhateverItsSize)
{
  for (const double edge : {1e-30, 0.3, 1.0, 1e30}) {
    const inr::ProjectedVoxel voxel(glm::dmat3(edge), edge);
    for (std::uint64_t number = 0; number < 50; ++number) {
      EXPECT_NEAR(voxel.across(RandomDirection(number)) / edge, 1, 1e-7);
    }
    EXPECT_EQ(voxel.across({0, 0, 1}), edge);
  }
}

/// Stripes of eight voxels across x, seen along z, with a pixel as large as a voxel there.
struct Stripes
{
  glm::i64vec3 dims;
  glm::dvec3 spacing;

  inr::Frame frame(inr::RenderMode mode) const
  {
    const glm::dvec3 size = glm::dvec3(this->dims) * this->spacing;
    const double edge = std::min(size.x, size.y);
    const glm::dvec2 low = 0.5 * (glm::dvec2(size) - edge);
    const int pixels = static_cast<int>(edge / this->spacing.x + 0.5) + 1;
    inr::Frame frame = ParallelFrame(pixels, low, low + edge, -size.z - 1, 2 * size.z + 1);
    frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / this->spacing);
    frame.unitDistance = size.z;
    frame.mode = mode;
    frame.samplesPerPixel = 1;
    frame.paths.emissionOnly = true;
    return frame;
  }

  inr::Image picture(inr::RenderMode mode, double scale) const
  {
    const double across = static_cast<double>(this->dims.x);
    inr::Renderer renderer = FieldRenderer(
        this->dims,
        [=](const glm::vec3& u) {
          return 0.5f +
                 0.5f * std::sin(static_cast<float>(glm::two_pi<double>() * u.x * across / 8));
        },
        {}, 2, true);
    renderer.setTransferFunction(OpacityRamp(0.9f));
    inr::Frame frame = this->frame(mode);
    frame.levelOfDetailScale = scale;
    return Render(renderer, frame);
  }
};

TEST(ProjectedVoxel, SlicesAreAsSharpAsTheirPixels)
{
  for (const Stripes& stripes :
       {Stripes{{64, 64, 32}, {1, 1, 0.2}}, Stripes{{64, 64, 32}, {1, 1, 5}},
        Stripes{{64, 64, 1}, {1, 1, 0.01}}, Stripes{{64, 64, 1}, {1, 1, 9}},
        Stripes{{32, 64, 32}, {3, 1, 1}}}) {
    for (const inr::RenderMode mode :
         {inr::RenderMode::RayMarching, inr::RenderMode::PathTracing}) {
      const inr::Image full = stripes.picture(mode, 0);
      EXPECT_EQ(full.pixels, stripes.picture(mode, 1).pixels) << stripes.spacing.z;
      EXPECT_NE(full.pixels, stripes.picture(mode, 2.5).pixels) << stripes.spacing.z;
    }
  }
}

TEST(ProjectedVoxel, FootprintsAreOfTheVoxelAsTheRaySeesIt)
{
  inr::Frame frame = ParallelFrame(32, {4, 4}, {28, 28}, -10, 200); // pixels of 3/4 along z
  for (const auto& [spacing, footprint] :
       {std::pair(glm::dvec3(1, 1, 5), 0.75), std::pair(glm::dvec3(1, 1, 0.1), 0.75),
        std::pair(glm::dvec3(5, 1, 1), 0.15), std::pair(glm::dvec3(0.1, 1, 1), 0.75)}) {
    frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / spacing);
    const inr::Ray ray = inr::RayGeometry(frame, {300, 33, 33}).ray(3, 3);
    EXPECT_NEAR(ray.footprint, footprint, 1e-9) << spacing.x << " " << spacing.z;
  }
  frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / glm::dvec3(60, 1, 1)); // a thick layer
  EXPECT_NEAR(inr::RayGeometry(frame, {1, 33, 33}).ray(3, 3).footprint, 0.75, 1e-9);
}

} // namespace test::projected_voxel
