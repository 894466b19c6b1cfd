// SPDX-License-Identifier: BSD-3-Clause
//
// Media with analytic transmittance: the picture must not depend on how finely it is sampled.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::medium {

constexpr double Steps[] = {0.1, 0.5, 1.0, 3.0};

/// With and without the cache.
class Medium : public testing::TestWithParam<bool>
{
protected:
  inr::Renderer renderer(const glm::i64vec3& dims, FieldEvaluator::Function function) const
  {
    return FieldRenderer(dims, std::move(function), {}, 2, this->GetParam());
  }
};

TEST_P(Medium, HomogeneousMatchesBeerLambertAtAnyStep)
{
  inr::Renderer renderer = this->renderer({33, 33, 33}, [](const glm::vec3&) { return 0.5f; });
  renderer.setTransferFunction(UniformMedium(0.1f, {0.25f, 0.5f, 1.0f}));
  for (const double step : Steps) {
    inr::Frame frame = ParallelFrame(8, {4, 4}, {28, 28}, -10, 50);
    frame.sampleDistance = step;
    frame.unitDistance = 4.0;
    const inr::Image image = Render(renderer, frame);
    const double alpha = 1.0 - std::pow(0.9, 32.0 / 4.0); // 32 = distance of the outer points
    for (int x = 0; x < 8; ++x) {
      EXPECT_NEAR(image.pixel(x, 3)[3], alpha, 1e-4) << step;
      EXPECT_NEAR(image.pixel(x, 3)[0], 0.25 * alpha, 1e-4) << step;
      EXPECT_NEAR(image.pixel(x, 3)[2], alpha, 1e-4) << step;
    }
  }
}

TEST_P(Medium, RampConvergesToQuadrature)
{
  inr::Renderer renderer = this->renderer({33, 33, 33}, [](const glm::vec3& u) { return u.z; });
  renderer.setTransferFunction(OpacityRamp(0.2f));
  // ln(1 - 0.2 u) integrated along z from 0.5/33 to 32.5/33, over a length of 32.
  const auto integral = [](double u) {
    const double rest = 1.0 - 0.2 * u;
    return -(rest * std::log(rest) - rest) / 0.2;
  };
  const double depth = (integral(32.5 / 33) - integral(0.5 / 33)) * 33;
  const double alpha = 1.0 - std::exp(depth);
  for (const double step : Steps) {
    inr::Frame frame = ParallelFrame(8, {4, 4}, {28, 28}, -10, 50);
    frame.sampleDistance = step;
    frame.levelOfDetailScale = 0; // coarse levels are flat in the outermost half of their voxels
    EXPECT_NEAR(Render(renderer, frame).pixel(4, 4)[3], alpha, 0.01 * step) << step;
  }
}

/// A field to be seen from anywhere.
inr::Renderer Mist(bool cached)
{
  inr::Renderer renderer = FieldRenderer(
      {17, 21, 9}, [](const glm::vec3& u) { return 0.3f + 0.7f * u.x * u.y * (1 - u.z); }, {}, 2,
      cached);
  renderer.setTransferFunction(OpacityRamp(0.6f));
  return renderer;
}

inr::Frame Oblique()
{
  inr::Frame frame;
  frame.width = frame.height = 24;
  frame.clipToWorld =
      glm::inverse(glm::perspective(glm::radians(40.0), 1.0, 5.0, 100.0) *
                   glm::lookAt(glm::dvec3(30, 25, 28), glm::dvec3(8, 10, 4), glm::dvec3(0, 1, 0)));
  frame.unitDistance = 5;
  frame.levelOfDetailScale = 0; // of lengths in the world
  frame.samplesPerPixel = 4;
  return frame;
}

/// The same volume and view after a host has put another matrix in front of the volume.
inr::Frame Moved(inr::Frame frame, const glm::dmat4& matrix)
{
  frame.clipToWorld = matrix * frame.clipToWorld;
  frame.worldToIndex = frame.worldToIndex * glm::inverse(matrix);
  frame.worldToMedium = glm::inverse(glm::dmat3(matrix));
  return frame;
}

TEST_P(Medium, IsNoDenserWhenItIsStretched)
{
  inr::Renderer renderer = Mist(this->GetParam());
  const glm::dmat4 one(1.0);
  const glm::dmat4 turn = glm::rotate(one, 0.7, glm::dvec3(1, 2, 3));
  for (const inr::RenderMode mode : {inr::RenderMode::RayMarching, inr::RenderMode::PathTracing}) {
    inr::Frame frame = Oblique();
    frame.mode = mode;
    frame.paths.emissionOnly = true;
    const inr::Image truth = Render(renderer, frame);
    ASSERT_GT(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 0.4f);
    for (const glm::dmat4& matrix :
         {glm::scale(one, glm::dvec3(0.01)), glm::scale(one, glm::dvec3(100.0)), turn,
          turn * glm::scale(one, glm::dvec3(1, 1, 10)) * glm::inverse(turn),
          glm::scale(one, glm::dvec3(3, -0.2, 1)) * turn}) {
      const inr::Image image = Render(renderer, Moved(frame, matrix));
      for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
        ASSERT_NEAR(image.pixels[k], truth.pixels[k], 1e-5) << k;
      }
    }
  }
}

TEST_P(Medium, ScattersTheSameWhenItIsScaled)
{
  inr::Renderer renderer = Mist(this->GetParam());
  inr::Frame frame = Oblique();
  frame.mode = inr::RenderMode::PathTracing;
  frame.paths.ambientLight = glm::vec3(0.5f);
  inr::Light light;
  light.kind = inr::LightKind::Point;
  light.position = {20, 30, 10};
  light.color = glm::vec3(3.0f);
  frame.lights = {light};
  const inr::Image truth = Render(renderer, frame);
  frame.lights[0].position *= 50.0;
  const inr::Image image =
      Render(renderer, Moved(frame, glm::scale(glm::dmat4(1.0), glm::dvec3(50.0))));
  for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
    ASSERT_NEAR(image.pixels[k], truth.pixels[k], 1e-5) << k;
  }
}

TEST_P(Medium, UnitDistanceIsAWorldLengthUnlessSaid)
{
  inr::Renderer renderer = this->renderer({17, 17, 17}, [](const glm::vec3&) { return 0.5f; });
  renderer.setTransferFunction(UniformMedium(0.1f));
  inr::Frame frame = ParallelFrame(4, {10, 10}, {20, 20}, -10, 200);
  frame.worldToIndex = glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / 5, 1.0 / 2, 1.0 / 3));
  frame.unitDistance = 6.0;
  EXPECT_NEAR(Render(renderer, frame).pixel(2, 2)[3], 1.0 - std::pow(0.9, 16.0 * 3 / 6), 1e-4);
}

TEST_P(Medium, FullyOpaqueIsOpaque)
{
  inr::Renderer renderer = this->renderer({9, 9, 9}, [](const glm::vec3&) { return 0.5f; });
  renderer.setTransferFunction(UniformMedium(1.0f));
  const inr::Image image = Render(renderer, ParallelFrame(4, {1, 1}, {7, 7}, -1, 10));
  EXPECT_EQ(image.pixel(1, 1)[3], 1.0f);
}

TEST_P(Medium, EmptyIsExactlyEmptyAndCostsNothing)
{
  inr::Renderer renderer = this->renderer({9, 9, 9}, [](const glm::vec3&) { return 0.5f; });
  renderer.setTransferFunction(UniformMedium(0.0f));
  inr::Image image;
  const inr::FrameStatistics statistics =
      renderer.render(ParallelFrame(16, {0, 0}, {8, 8}, -1, 10), image);
  EXPECT_EQ(image.pixels, std::vector<float>(16 * 16 * 4, 0.0f));
  EXPECT_EQ(statistics.samples, 0);
  EXPECT_EQ(statistics.rays, GetParam() ? 0 : 256); // the cached ones are not even begun
}

INSTANTIATE_TEST_SUITE_P(Rays, Medium, testing::Bool(),
                         [](const auto& info) { return info.param ? "Cached" : "Uncached"; });

} // namespace test::medium
