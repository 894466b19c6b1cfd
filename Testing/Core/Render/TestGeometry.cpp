// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Render/Rays/RayGeometry.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace test::geometry {

const glm::i64vec3 Dims(9, 9, 9);

/// Opacity of the volume's homogeneous medium over `length` world units.
double AlphaOver(double length) { return 1.0 - std::pow(0.9, length); }

inr::Renderer Homogeneous(const glm::i64vec3& dims)
{
  inr::Renderer renderer = FieldRenderer(dims, [](const glm::vec3&) { return 0.5f; });
  renderer.setTransferFunction(UniformMedium(0.1f));
  return renderer;
}

TEST(Geometry, VisibleDomainEndsAtTheOuterPoints)
{
  inr::Renderer renderer = Homogeneous(Dims);
  // 12 pixels over [-2, 10]: pixel k covers [k - 2, k - 1], its centre is at k - 1.5.
  const inr::Image image = Render(renderer, ParallelFrame(12, {-2, -2}, {10, 10}, -5, 20));
  for (int x = 0; x < 12; ++x) {
    const bool inside = x >= 2 && x < 10;
    EXPECT_EQ(image.pixel(x, 5)[3] > 0, inside) << x;
    EXPECT_EQ(image.pixel(5, x)[3] > 0, inside) << x;
  }
}

TEST(Geometry, ValuesSitAtTheirVoxel)
{
  // Opaque from half a voxel before voxel 6 in x: u >= 6/9.
  inr::Renderer renderer =
      FieldRenderer(Dims, [](const glm::vec3& u) { return u.x >= 6.0f / 9 ? 1.0f : 0.0f; });
  renderer.setTransferFunction(OpacityRamp(0.9f));
  const inr::Image image = Render(renderer, ParallelFrame(80, {0, 0}, {8, 8}, -5, 20));
  EXPECT_EQ(image.pixel(54, 40)[3], 0.0f); // x = 5.45
  EXPECT_GT(image.pixel(55, 40)[3], 0.5f); // x = 5.55: voxel 6 begins at 5.5
}

TEST(Geometry, SlabIsOneSpacingThick)
{
  inr::Renderer renderer = Homogeneous({9, 9, 1});
  const inr::Image image = Render(renderer, ParallelFrame(4, {1, 1}, {7, 7}, -5, 5));
  EXPECT_NEAR(image.pixel(2, 2)[3], AlphaOver(1.0), 1e-5);
}

TEST(Geometry, SlabIsAskedAtItsVoxelOnly)
{
  inr::Renderer renderer = FieldRenderer(
      {9, 9, 1}, [](const glm::vec3& u) { return u.z == 0.5f ? 0.25f : std::nanf(""); });
  renderer.setTransferFunction(OpacityRamp(0.4f));
  inr::Image image;
  renderer.render(ParallelFrame(4, {1, 1}, {7, 7}, -5, 5), image);
  EXPECT_NEAR(image.pixel(2, 2)[3], 0.1f, 1e-5);
}

TEST(Geometry, CameraInsideSeesWhatIsAhead)
{
  inr::Renderer renderer = Homogeneous(Dims);
  const inr::Image image = Render(renderer, ParallelFrame(4, {1, 1}, {7, 7}, 3, 20));
  EXPECT_NEAR(image.pixel(2, 2)[3], AlphaOver(5.0), 1e-5);
}

TEST(Geometry, OpaqueDepthEndsTheRayExactly)
{
  inr::Renderer renderer = Homogeneous(Dims);
  inr::Frame frame = ParallelFrame(2, {1, 1}, {7, 7}, -5, 15);
  const float background = 1.0f;
  const float depth[] = {background, 0.25f, 0.5f, 0.1f}; // z = none, 0, 5, -3
  frame.opaqueDepth = depth;
  const inr::Image image = Render(renderer, frame);
  EXPECT_NEAR(image.pixel(0, 0)[3], AlphaOver(8), 1e-5);
  EXPECT_EQ(image.pixel(1, 0)[3], 0.0f);
  EXPECT_NEAR(image.pixel(0, 1)[3], AlphaOver(5), 1e-5);
  EXPECT_EQ(image.pixel(1, 1)[3], 0.0f);
}

TEST(Geometry, ClippingPlanesCutBothEnds)
{
  inr::Renderer renderer = Homogeneous(Dims);
  inr::Frame frame = ParallelFrame(2, {1, 1}, {7, 7}, -5, 15);
  frame.clippingPlanes = {{0, 0, 1, -2}, {0, 0, -1, 6}}; // 2 <= z <= 6
  EXPECT_NEAR(Render(renderer, frame).pixel(0, 0)[3], AlphaOver(4), 1e-5);
  frame.clippingPlanes = {{0, 0, 0, -1}}; // keeps nothing
  EXPECT_EQ(Render(renderer, frame).pixel(0, 0)[3], 0.0f);
}

TEST(Geometry, RotatedScaledAndMirroredVolumesKeepWorldLengths)
{
  inr::Renderer renderer = Homogeneous(Dims);
  for (const double mirror : {1.0, -1.0}) {
    // Index to world: scale, turn by 90 degrees about y (index x lies along world z), shift.
    glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(3, -2, 1));
    toWorld = glm::rotate(toWorld, 1.5707963267948966, glm::dvec3(0, 1, 0));
    toWorld = glm::scale(toWorld, glm::dvec3(2 * mirror, 1, 0.5));
    inr::Frame frame = ParallelFrame(3, {4, -1}, {6, 5}, -40, 40);
    frame.worldToIndex = glm::inverse(toWorld);
    EXPECT_NEAR(Render(renderer, frame).pixel(1, 1)[3], AlphaOver(16), 1e-4) << mirror;
  }
}

TEST(Geometry, PerspectiveRaysMeetTheirDepth)
{
  const glm::dmat4 view =
      glm::lookAt(glm::dvec3(4, 4, -20), glm::dvec3(4, 4, 4), glm::dvec3(0, 1, 0));
  inr::Frame frame;
  frame.width = 5;
  frame.height = 5;
  frame.clipToWorld = glm::inverse(glm::perspective(0.6, 1.0, 1.0, 100.0) * view);
  const inr::RayGeometry geometry(frame, Dims);
  const inr::Ray middle = geometry.ray(2, 2);
  EXPECT_NEAR(middle.entry.z, 0.0, 1e-9);
  EXPECT_NEAR(middle.length, 8.0, 1e-9);
  // A point's window depth, read back as opaque depth, ends the ray at that point.
  std::vector<float> depth(25, static_cast<float>(geometry.windowDepth(middle.at(3.0))));
  frame.opaqueDepth = depth.data();
  EXPECT_NEAR(inr::RayGeometry(frame, Dims).ray(2, 2).length, 3.0, 1e-3);
}

TEST(Geometry, HugeVolumesKeepTheirDigits)
{
  // A voxel-sized feature near the far corner of a 2^17 volume, far from the world's origin.
  const std::int64_t n = std::int64_t{1} << 17;
  const double far = 1e7;
  inr::Frame frame =
      ParallelFrame(3, {far + n - 3, far + n - 3}, {far + n, far + n}, -10, n + 10.0);
  frame.worldToIndex = glm::translate(glm::dmat4(1.0), glm::dvec3(-far, -far, 0));
  const inr::RayGeometry geometry(frame, {n, n, n});
  const inr::Ray ray = geometry.ray(0, 0);
  EXPECT_NEAR(ray.at(ray.length).x, n - 2.5, 1e-6);
  EXPECT_NEAR(ray.length, n - 1.0, 1e-6);
}

TEST(Geometry, RefusesImpossibleFrames)
{
  inr::Renderer renderer = Homogeneous(Dims);
  const auto refused = [&](const std::function<void(inr::Frame&)>& spoil) {
    inr::Frame frame = ParallelFrame(2, {0, 0}, {8, 8}, -5, 15);
    spoil(frame);
    EXPECT_THROW(Render(renderer, frame), inr::Error);
  };
  refused([](inr::Frame& frame) { frame.width = 0; });
  refused([](inr::Frame& frame) { frame.width = frame.height = 1 << 21; });
  refused([](inr::Frame& frame) { frame.sampleDistance = 0; });
  refused([](inr::Frame& frame) { frame.sampleDistance = 1e-300; });
  refused([](inr::Frame& frame) { frame.sampleDistance = std::nan(""); });
  refused([](inr::Frame& frame) { frame.levelOfDetailScale = -1; });
  refused([](inr::Frame& frame) { frame.timeLimit = std::nan(""); });
  refused([](inr::Frame& frame) { frame.unitDistance = std::nan(""); });
  refused([](inr::Frame& frame) { frame.clippingPlanes.emplace_back(0, 0, std::nan(""), 1); });
  refused([](inr::Frame& frame) { frame.clippingPlanes.emplace_back(1, 0, 0, HUGE_VAL); });
  refused([](inr::Frame& frame) { frame.piece.emplace_back(1, 0, 0, std::nan("")); });
  refused([](inr::Frame& frame) { frame.worldToIndex = glm::dmat4(0.0); });
  refused([](inr::Frame& frame) { frame.clipToWorld[1][1] = HUGE_VAL; });
  EXPECT_NO_THROW(Render(renderer, ParallelFrame(2, {0, 0}, {8, 8}, -5, 15)));
}

} // namespace test::geometry
