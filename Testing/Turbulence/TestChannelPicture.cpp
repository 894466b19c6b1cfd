// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Testing/Core/Render/Scene.h"
#include "Testing/Turbulence/ChannelPicture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::channel_picture {

inr::TurbulentChannel Field(double intensity)
{
  inr::TurbulentChannel::Parameters parameters;
  parameters.intensity = intensity;
  return inr::TurbulentChannel(parameters);
}

const char* const Oblique = R"({"dims": [90, 70, 40], "size": [31, 23], "position": [-9, -12, 14],
  "focal_point": [12, 5, 1], "view_up": [0.1, 0.2, 1], "view_angle": 40,
  "clipping_range": [1, 100], "sample_distance": 0.4, "unit_distance": 2, "seed": 3,
  "colors": [[0, 0, 0.2, 1, 0], [0.5, 0.9, 1, 0.2, 0.1], [1, 1, 0.1, 0, 0.6], [1.5, 1, 1, 1, 0.1]]})";

/// One pixel that looks straight down through the middle of the channel.
inr::ChannelScene Down(double sampleDistance)
{
  inr::ChannelScene scene = inr::ParseChannelScene(
      R"({"dims": [40, 30, 20], "size": [1, 1], "position": [10, 4, 9], "focal_point": [10, 4, 0],
      "view_up": [0, 1, 0], "view_angle": 20, "clipping_range": [1, 20], "sample_distance": 1,
      "unit_distance": 0.7, "seed": 0, "colors": [[0, 0.5, 0.25, 1, 0.3]]})");
  scene.frame.sampleDistance = sampleDistance;
  return scene;
}

inr::TransferFunction TableOf(const inr::ChannelScene& scene)
{
  inr::TransferFunction function;
  function.low = scene.colors.begin()->first;
  function.high = scene.colors.rbegin()->first;
  for (const auto& [value, color] : scene.colors) { // which are equally far apart
    function.table.emplace_back(color);
  }
  function.below = function.table.front();
  function.above = function.table.back();
  return function;
}

class ChannelSteps : public testing::TestWithParam<double> // voxels
{};

// Of long steps many a last one is cut. The renderer asks the same field, in float and by other
// code from the rays on.
TEST_P(ChannelSteps, AreWhatTheRendererMakesOfTheField)
{
  const inr::TurbulentChannel field = Field(0.06);
  inr::ChannelScene scene = inr::ParseChannelScene(Oblique);
  scene.frame.adaptiveSampling = false;
  scene.frame.sampleDistance = GetParam();
  inr::VolumeInfo info = VolumeOf(scene.dims);
  info.low = -0.5;
  info.high = 2;
  const auto evaluator = std::make_shared<FieldEvaluator>([&](const glm::vec3& u) {
    return static_cast<float>((field.at(glm::dvec3(u)) - info.low) / (info.high - info.low));
  });
  inr::RendererOptions options;
  options.threads = 2;
  options.cached = false;
  inr::Renderer renderer(evaluator, info, {}, options);
  renderer.setTransferFunction(TableOf(scene));
  const inr::Image expected = Render(renderer, scene.frame);
  const inr::Image picture = inr::DrawChannel(field, scene, inr::Arena(2));
  ASSERT_EQ(picture.pixels.size(), expected.pixels.size());
  float most = 0;
  for (std::size_t k = 0; k < picture.pixels.size(); ++k) {
    EXPECT_NEAR(picture.pixels[k], expected.pixels[k], 1e-4) << k;
    most = std::max(most, expected.pixels[k]);
  }
  EXPECT_GT(most, 0.5);
  EXPECT_LT(most, 0.99) << "the renderer would have stopped earlier";
}

// Of one node, whose color is that of all values, above it and below.
TEST(ChannelPicture, IsTheClosedFormOfAUniformMedium)
{
  const double way = 2 - 2.0 / 20; // from the first voxel's centre to the last one's
  for (const double node : {0.0, 2.0}) {
    for (const double opacity : {0.3, 0.97}) { // of which there is something behind what is opaque
      for (const double sampleDistance : {0.3, 0.012}) {
        inr::ChannelScene scene = Down(sampleDistance);
        scene.colors = {{node, glm::dvec4(0.5, 0.25, 1, opacity)}};
        std::int64_t samples = 0;
        const inr::Image picture = inr::DrawChannel(Field(0.06), scene, inr::Arena(1), &samples);
        const double alpha = 1 - std::pow(1 - opacity, way / 0.7);
        EXPECT_NEAR(picture.pixels[3], alpha, 2e-6);
        EXPECT_NEAR(picture.pixels[0], 0.5 * alpha, 2e-6);
        EXPECT_EQ(samples, static_cast<std::int64_t>(std::ceil(19 / sampleDistance)));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ChannelPicture, ChannelSteps, testing::Values(0.4, 7.0));

// At the place in the world where the source has it.
TEST(ChannelPicture, ComesToTheIntegralOfTheField)
{
  for (const double intensity : {0.0, 0.3}) {
    const inr::TurbulentChannel field = Field(intensity);
    inr::ChannelScene scene = Down(0.002);
    scene.colors = {{0, glm::dvec4(1, 1, 1, 0)}, {1, glm::dvec4(1, 1, 1, 0.8)}};
    constexpr int steps = 20000;
    const double x = 10 / inr::TurbulentChannel::Size.x;
    const double y = 4 / inr::TurbulentChannel::Size.y;
    double depth = 0;
    for (int k = 0; k < steps; ++k) {
      const double z = (0.5 + 19 * (k + 0.5) / steps) / 20;
      const double value = std::clamp(field.at({x, y, z}), 0.0, 1.0);
      depth -= std::log1p(-0.8 * value) * (1.9 / steps) / 0.7;
    }
    const inr::Image picture = inr::DrawChannel(field, scene, inr::Arena(1));
    EXPECT_NEAR(picture.pixels[3], 1 - std::exp(-depth), 1e-5);
  }
}

TEST(ChannelPicture, DoesNotDependOnThreads)
{
  const inr::ChannelScene scene = inr::ParseChannelScene(Oblique);
  EXPECT_EQ(inr::DrawChannel(Field(0.06), scene, inr::Arena(1)).pixels,
            inr::DrawChannel(Field(0.06), scene, inr::Arena(2)).pixels);
}

TEST(ChannelPicture, RefusesScenesThatLackSomething)
{
  for (const char* text : {"", "[]", R"({"dims": [1, 2, 3]})"}) {
    EXPECT_THROW(inr::ParseChannelScene(text), inr::Error) << text;
  }
  inr::ChannelScene scene = Down(1);
  scene.colors.clear();
  EXPECT_THROW(inr::DrawChannel(Field(0), scene, inr::Arena(1)), inr::Error);
}

} // namespace test::channel_picture
