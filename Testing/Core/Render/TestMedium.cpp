// SPDX-License-Identifier: BSD-3-Clause
//
// Media with analytic transmittance: the picture must not depend on how finely it is sampled.
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

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

TEST_P(Medium, UnitDistanceIsAWorldLength)
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

} // namespace
