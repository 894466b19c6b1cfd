// SPDX-License-Identifier: BSD-3-Clause
//
// A tolerance where geometry is extreme: against every sample from the full resolution.
#include "Testing/Core/Image/PixelDifferences.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace test::extreme_tolerances {

const glm::i64vec3 Dims(72, 64, 68);

/// What is extreme.
struct Geometry
{
  const char* name;
  glm::dvec3 spacing;
  glm::dvec3 origin;
  glm::dvec3 eye;    ///< voxels
  glm::dvec3 target; ///< voxels
  double angle;      ///< of view, degrees; 0: parallel
  double across = 0; ///< of a parallel view, in spacings of x
  double unit = 4;   ///< opacity unit distance, in the least spacing
  int pixels = 64;   ///< across
  /// Whether much is: 144,000 steps to a ray each have too small a part of a tolerance.
  bool spared = true;
};

std::ostream& operator<<(std::ostream& out, const Geometry& geometry)
{
  return out << geometry.name;
}

const glm::dvec3 Middle(35.5, 31.5, 33.5);

std::vector<Geometry> Geometries()
{
  const glm::dvec3 one(1);
  const glm::dvec3 none(0);
  return {
      {"Plain", one, none, {160, 120, 190}, Middle, 40},
      {"LongVoxels", {1, 1, 1000}, none, {300, 120, 34}, Middle, 0, 100},
      {"LongVoxelsAlongRays", {1, 1, 1000}, none, {35.7, 31.2, 500}, Middle, 0, 90, 500, 14},
      {"FlatVoxels", {1, 1, 1e-3}, none, {35.7, 31.2, 500}, Middle, 0, 90, 4},
      {"FlatVoxelsFromTheSide", {1, 1, 1e-3}, none, {300, 32, 60}, Middle, 0, 0.09, 500, 14, false},
      {"FarAway", one, {1e6, -1e6, 3e6}, {160, 120, 190}, Middle, 40},
      {"FarAwayAndTiny", one * 1e-6, {1, -1, 3}, {160, 120, 190}, Middle, 40},
      {"AlmostAlongVoxels", one, none, {35.5 + 1e-5, 31.5 - 1e-6, 300}, Middle, 0, 90},
      {"BetweenVoxels", one, none, {35.5, 31.5, 300}, Middle, 0, 90},
      {"GrazingAFace", one, none, {-400, 31.5, 67.2}, {71, 31.5, 66.9}, 8},
      {"AlongAnEdge", one, none, {-300, 0.02, 0.03}, {71, 0.01, 0.01}, 2},
      {"Inside", one, none, {30.2, 28.4, 40.1}, {60, 20, 5}, 100},
      {"InAWire", one, none, {21.5, 25.3, 3}, {24, 25.1, 60}, 70},
      {"OnAFace", one, none, {35, 0, 30}, {36, 60, 31}, 120},
      {"FromAfar", one, none, {2e5, 1e5, 3e5}, Middle, 0.02}};
}

class ExtremeTolerance : public testing::TestWithParam<Geometry>
{
protected:
  static inr::Renderer renderer()
  {
    const auto voxels = std::make_shared<const Voxels>(Dims, FogAndWires);
    const auto field = [voxels](const glm::vec3& u) { return voxels->at(u); };
    inr::RendererOptions options;
    options.threads = 2;
    options.cache = Options(inr::CachePrecision::Float32, 16);
    inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(Dims),
                           CellsOf(field, Dims), options);
    renderer.setTransferFunction(Glow());
    return renderer;
  }

  static inr::Frame frame(const Geometry& geometry)
  {
    const glm::dmat4 indexToWorld =
        glm::scale(glm::translate(glm::dmat4(1.0), geometry.origin), geometry.spacing);
    const auto world = [&](const glm::dvec3& index) {
      return glm::dvec3(indexToWorld * glm::dvec4(index, 1));
    };
    const glm::dvec3 eye = world(geometry.eye);
    const glm::dvec3 target = world(geometry.target);
    const double size = glm::length(glm::dvec3(Dims) * geometry.spacing);
    const double across = 0.5 * geometry.across * geometry.spacing.x;
    const double away = glm::distance(eye, target);
    const glm::dvec3 way = (target - eye) / away;
    const glm::dvec3 up = std::abs(way.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const double least =
        std::min(geometry.spacing.x, std::min(geometry.spacing.y, geometry.spacing.z));
    inr::Frame frame;
    frame.width = frame.height = geometry.pixels;
    frame.worldToIndex = glm::inverse(indexToWorld);
    const glm::dmat4 lens =
        geometry.angle > 0
            ? glm::perspective(glm::radians(geometry.angle), 1.0,
                               std::max(away - size, 1e-3 * std::min(away, size)), away + size)
            : glm::ortho(-across, across, -across, across, away - size, away + size);
    frame.clipToWorld = glm::inverse(lens * glm::lookAt(eye, target, up));
    frame.unitDistance = geometry.unit * least;
    frame.sampleDistance = 0.5;
    return frame;
  }
};

TEST_P(ExtremeTolerance, IsKept)
{
  inr::Renderer renderer = this->renderer();
  inr::Frame frame = this->frame(this->GetParam());
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  ASSERT_GT(exact.statistics.samples, 1000);
  std::int64_t fewest = exact.statistics.samples;
  for (const double tolerance : {1.0, 8.0, 40.0, 100.0}) {
    frame.errorTolerance = tolerance;
    const Drawn drawn = Draw(renderer, frame);
    const std::vector<float> differences = PixelDifferences(drawn.picture, exact.picture);
    ASSERT_GT(differences.size(), 80u);
    EXPECT_GE(ShareWithin(tolerance, differences), 0.999) << tolerance;
    fewest = std::min(fewest, drawn.statistics.samples);
  }
  if (this->GetParam().spared) {
    EXPECT_LT(fewest, 0.95 * static_cast<double>(exact.statistics.samples));
  }
}

INSTANTIATE_TEST_SUITE_P(Geometries, ExtremeTolerance, testing::ValuesIn(Geometries()),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace test::extreme_tolerances
