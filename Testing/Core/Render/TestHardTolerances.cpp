// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes in which a tolerance is hard to keep.
#include "Core/Random.h"
#include "Testing/Core/Image/PixelDifferences.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace test::hard_tolerances {

/// What is hard about a scene.
struct HardScene
{
  const char* name;
  FieldEvaluator::Function field;
  inr::TransferFunction colours;
  glm::dvec3 along;   ///< way of parallel rays
  double spacing = 1; ///< of z, in those of x and y
  double unitDistance = 8;
};

inr::TransferFunction Ramp(const glm::vec4& from, const glm::vec4& to)
{
  inr::TransferFunction function;
  for (int k = 0; k < 256; ++k) {
    function.table.push_back(glm::mix(from, to, static_cast<float>(k) / 255));
  }
  return function;
}

/// One every three voxels of a gradient over 96.
inr::TransferFunction Peaks()
{
  inr::TransferFunction function;
  for (int k = 0; k < 1024; ++k) {
    const float place = 32.0f * static_cast<float>(k) / 1023;
    const float peak = std::max(0.0f, 1 - 4 * std::abs(place - std::floor(place) - 0.5f));
    function.table.emplace_back(1, 1, 1, 0.3f * peak);
  }
  return function;
}

FieldEvaluator::Function Waves(const glm::vec3& perVoxel)
{
  return [perVoxel](const glm::vec3& u) {
    return 0.5f + 0.45f * std::cos(6.2831853f * glm::dot(perVoxel, 96.0f * u));
  };
}

/// About two voxels thick, 24 apart.
FieldEvaluator::Function Sheets(const glm::vec3& normal)
{
  return [across = glm::normalize(normal)](const glm::vec3& u) {
    const float place = glm::dot(across, 96.0f * u) / 24;
    const float distance = 24 * (place - std::round(place));
    return 0.1f + 0.8f * std::exp(-distance * distance);
  };
}

float Noise(const glm::vec3& u)
{
  const glm::i64vec3 voxel(96.0f * u);
  return static_cast<float>(
      inr::RandomUnit(21, static_cast<std::uint64_t>(voxel.x + 100 * (voxel.y + 100 * voxel.z))));
}

/// What a function of the voxel gives, and linear in between.
FieldEvaluator::Function Linear(const std::function<float(const glm::i64vec3&)>& valueOf)
{
  const auto voxels = std::make_shared<const Voxels>(
      glm::i64vec3(96), [&](const glm::vec3& u) { return valueOf(glm::i64vec3(96.0f * u)); });
  return [voxels](const glm::vec3& u) { return voxels->at(u); };
}

float Layer(const glm::i64vec3& at) { return at.z % 24 == 8 ? 0.9f : 0.1f; }

float Checkerboard(const glm::i64vec3& at)
{
  return (at.x / 16 + at.y / 16 + at.z / 16) % 2 == 0 ? 0.9f : 0.1f;
}

float Gyroid(const glm::i64vec3& at)
{
  const glm::vec3 a = 1.5707963f * (glm::vec3(at) + 0.5f); // four voxels to a turn
  return 0.5f + 0.25f * (std::sin(a.x) * std::cos(a.y) + std::sin(a.y) * std::cos(a.z) +
                         std::sin(a.z) * std::cos(a.x));
}

std::ostream& operator<<(std::ostream& out, const HardScene& scene) { return out << scene.name; }

std::vector<HardScene> HardScenes()
{
  const inr::TransferFunction faint = Ramp({1, 0.5f, 0, 0}, {1, 0.5f, 0, 0.05f});
  const inr::TransferFunction opaque = Ramp({1, 0.2f, 0, 1}, {0, 0.5f, 1, 0});
  const inr::TransferFunction bright = Ramp({20, 0, 1, 0.01f}, {0, 0, 1, 0.1f});
  inr::TransferFunction middle = Ramp({1, 0.7f, 0, 0.05f}, {1, 0.7f, 0, 0.05f});
  middle.low = 0.4;
  middle.high = 0.6;
  inr::TransferFunction upper = middle;
  upper.high = 1;
  inr::TransferFunction lower = Ramp({1, 0.5f, 0.2f, 0}, {1, 0.5f, 0.2f, 0.02f});
  lower.high = 0.6;
  lower.above = {1, 1, 1, 0.6f};
  inr::TransferFunction lamp = Ramp({0, 0, 0, 0}, {0, 0, 0, 0.1f});
  std::fill(lamp.table.begin() + 200, lamp.table.end(), glm::vec4(20, 20, 20, 0.5f));
  const auto smokeBeforeLamp = [](const glm::vec3& u) {
    return u.z > 0.5f ? 0.9f : 0.4f + 0.3f * std::cos(40 * u.x);
  };
  const glm::dvec3 z(0, 0, 1);
  return {{"LayersAlongRays", Waves({1.0f / 24, 0, 0}), faint, z},
          {"ShortLayersAlongRays", Waves({1.0f / 16, 0, 0}), faint, z},
          {"LayersAlongLongVoxels", Waves({1.0f / 16, 0, 0}), faint, z, 8, 64},
          {"ObliqueLayers", Waves(glm::vec3(1, 1, -2) / 40.0f), faint, {1, 1, 1}},
          {"LayersAtOddAngles", Waves(glm::vec3(3, -5, 0) / 90.0f), faint, {5, 3, 1}},
          {"SheetsAtOddAngles", Sheets({1, 2, -7}), faint, {3, 2, 1}},
          {"SheetsAcross", Sheets({2, 1, 5}), faint, {2, 1, 5}},
          {"SlopingSlices", Waves({1.0f / 60, 0, 1.0f / 24}), faint, {0.05, 0, 1}, 8},
          {"Noise", Noise, faint, {1, 2, 5}},
          {"LayersOfAVoxel", Linear(Layer), faint, z},
          {"Checkerboard", Linear(Checkerboard), faint, {1, 0.3, 0.2}},
          {"Gyroid", Linear(Gyroid), faint, z},
          {"OpacityOfOne", Waves({1.0f / 30, 0, 1.0f / 50}), opaque, z, 1, 1},
          {"FarApartSlices", Waves({1.0f / 60, 0, 1.0f / 40}), faint, {1, 0.1, 0}, 30, 8},
          {"EdgeBelow", Waves({1.0f / 40, 0, 1.0f / 50}), upper, {0.3, 0.2, 1}},
          {"EdgeAbove", Waves({1.0f / 40, 0, 1.0f / 50}), lower, {0.3, 0.2, 1}},
          {"EdgesOfTheMiddle", Waves({1.0f / 40, 0, 1.0f / 50}), middle, {0.3, 0.2, 1}},
          {"SmokeBeforeALamp", smokeBeforeLamp, lamp, z},
          {"BrightColours", Waves({1.0f / 40, 1.0f / 50, 0}), bright, {0.3, 0.2, 1}},
          {"PeaksInAGradient", [](const glm::vec3& u) { return u.z; }, Peaks(), z},
          {"OneOpacity",
           Waves({0, 1.0f / 8, 0}),
           Ramp({0, 1, 0, 0.05f}, {1, 0, 1, 0.05f}),
           {0.1, 1, 0.05},
           1,
           2}};
}

/// A hard scene, and a picture of all of it.
class HardPicture
{
public:
  explicit HardPicture(const HardScene& scene)
      : Renderer(std::make_shared<FieldEvaluator>(scene.field), VolumeOf(Dims),
                 CellsOf(scene.field, Dims), TwoThreads())
  {
    this->Renderer.setTransferFunction(scene.colours);
    const glm::dvec3 stretch(1, 1, scene.spacing);
    const glm::dvec3 middle = 47.5 * stretch;
    const double reach = glm::length(middle);
    const glm::dvec3 up = std::abs(scene.along.z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    this->Frame.width = this->Frame.height = 64;
    this->Frame.unitDistance = scene.unitDistance;
    this->Frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / stretch);
    this->Frame.clipToWorld =
        glm::inverse(glm::ortho(-reach, reach, -reach, reach, -2 * reach, 2 * reach) *
                     glm::lookAt(middle, middle + scene.along, up));
  }

  Drawn drawWith(double tolerance, double sampleDistance)
  {
    this->Frame.sampleDistance = sampleDistance;
    this->Frame.errorTolerance = tolerance;
    return Draw(this->Renderer, this->Frame);
  }

private:
  static inr::RendererOptions TwoThreads()
  {
    inr::RendererOptions options;
    options.threads = 2;
    options.cache = Options(inr::CachePrecision::Float32, 16);
    return options;
  }

  static constexpr glm::i64vec3 Dims{96, 96, 96};
  inr::Renderer Renderer;
  inr::Frame Frame;
};

class HardToKeepTo : public testing::TestWithParam<HardScene>
{};

TEST_P(HardToKeepTo, ATolerance)
{
  HardPicture picture(this->GetParam());
  for (const double distance : {0.5, 4.0}) {
    const Drawn exact = picture.drawWith(0, distance);
    EXPECT_GT(exact.statistics.samples, 1000);
    for (const double tolerance : {0.5, 2.0, 8.0, 32.0, 52.0}) {
      const Drawn drawn = picture.drawWith(tolerance, distance);
      EXPECT_GE(ShareWithin(tolerance, PixelDifferences(drawn.picture, exact.picture)), 0.999)
          << tolerance << " " << distance;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardToKeepTo, testing::ValuesIn(HardScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

} // namespace test::hard_tolerances
