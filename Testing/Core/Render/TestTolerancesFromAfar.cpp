// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes that are small in a picture, where few of the rays that look ahead meet what pixels show.
#include "Core/Image/Metrics.h"
#include "Core/Random.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace test::tolerances_from_afar {

struct Afar
{
  double worst;   ///< of all pixels, as part of the tolerance
  double samples; ///< as part of the exact picture's
};

/// A picture of 480 x 480 pixels, `zoom` times as wide as the volume of `size` voxels a side.
Afar LookFromAfar(const FieldEvaluator::Function& field, std::int64_t size, int edge,
                  const inr::TransferFunction& colours, const glm::dvec3& along, double zoom,
                  double tolerance)
{
  const glm::i64vec3 dims(size);
  const Voxels voxels(dims, field);
  const auto linear = [&](const glm::vec3& u) { return voxels.at(u); };
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(linear), VolumeOf(dims),
                         CellsOf(linear, dims, edge), options);
  renderer.setTransferFunction(colours);
  const glm::dvec3 middle(0.5 * static_cast<double>(size - 1));
  const double reach = glm::length(middle) + 0.5;
  const double across = zoom * reach;
  inr::Frame frame;
  frame.width = frame.height = 480;
  frame.unitDistance = 8;
  frame.clipToWorld =
      glm::inverse(glm::ortho(-across, across, -across, across, -2 * reach, 2 * reach) *
                   glm::lookAt(middle, middle + along, glm::dvec3(0, 1, 0)));
  frame.sampleDistance = 0.5;
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = tolerance;
  const Drawn drawn = Draw(renderer, frame);
  return {255 * inr::ImageMaximumError(drawn.picture, exact.picture) / tolerance,
          static_cast<double>(drawn.statistics.samples) /
              static_cast<double>(exact.statistics.samples)};
}

inr::TransferFunction Colours(float from, float most)
{
  inr::TransferFunction function;
  for (int k = 0; k < 256; ++k) {
    const float x = static_cast<float>(k) / 255;
    function.table.emplace_back(1, 0.5f, 0.2f, most * std::max(0.0f, x - from) / (1 - from));
  }
  return function;
}

/// Rays for the whole picture would be ten pixels apart: two or three of them per cell, all far
/// from its middle, would say too much or too little.
TEST(TolerancesFromAfar, AreFoundWithRaysThatAreAsCloseAsTheVolumeNeeds)
{
  const glm::dvec3 along(3, 2, 1);
  const auto fibres = [&](const glm::vec3& u) {
    const glm::dvec3 a = glm::normalize(glm::cross(along, glm::dvec3(0.3, -0.2, 1)));
    const glm::dvec3 b = glm::cross(glm::normalize(along), a);
    const glm::dvec3 from = 96.0 * glm::dvec3(u) - 48.0;
    const glm::dvec2 place = glm::dvec2(glm::dot(from, a), glm::dot(from, b)) / 8.0;
    const glm::dvec2 off = 8.0 * (place - glm::round(place));
    return static_cast<float>(0.05 + 0.9 * std::exp(-glm::dot(off, off) / 1.44));
  };
  const Afar seen = LookFromAfar(fibres, 96, 16, Colours(0, 0.05f), along, 6, 32);
  EXPECT_LT(seen.worst, 0.25);
  EXPECT_LT(seen.samples, 0.3);
}

/// Pixels between those rays see all of a cell of which they met a corner.
TEST(TolerancesFromAfar, CountCellsWholeThatRaysMeetAtTheirCorners)
{
  const auto specks = [](const glm::vec3& u) {
    const glm::dvec3 voxel = 160.0 * glm::dvec3(u) - 0.5;
    const glm::i64vec3 box(voxel / 32.0);
    const auto random = [&](std::uint64_t number) {
      return static_cast<double>(inr::RandomUnit(
          40 + number, static_cast<std::uint64_t>(box.x + 1000 * box.y + 1000000 * box.z)));
    };
    const glm::dvec3 middle =
        glm::dvec3(box) * 32.0 + 8.0 + 16.0 * glm::dvec3(random(1), random(2), random(3));
    const glm::dvec3 off = voxel - middle;
    return random(0) > 0.3 ? 0.0f : static_cast<float>(std::exp(-glm::dot(off, off) / 4));
  };
  const Afar seen = LookFromAfar(specks, 160, 8, Colours(0.05f, 0.2f), {1, 2, 3}, 10, 16);
  EXPECT_LT(seen.worst, 0.25);
  EXPECT_LT(seen.samples, 0.9);
}

} // namespace test::tolerances_from_afar
