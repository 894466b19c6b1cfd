// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace test::jitter {

constexpr glm::i64vec3 Dims(64);

/// How far from the centre, so that surfaces of one value are crossed at all angles.
float Radius(const glm::vec3& u) { return 2 * glm::length(u - 0.5f); }

/// Two thin shells, which samples two voxels apart meet here and miss there.
inr::TransferFunction Shells()
{
  inr::TransferFunction function;
  for (int k = 0; k < 128; ++k) {
    const bool inside = k / 3 == 20 || k / 3 == 30;
    function.table.emplace_back(1, 1, 1, inside ? 0.02f : 0);
  }
  return function;
}

struct Residual
{
  double correlation = 0; ///< of neighbours along rows: near 1 in bands, 0 of noise
  double mean = 0;        ///< relative to the deviation
  double deviation = 0;
};

Residual Compare(const inr::Image& picture, const inr::Image& truth)
{
  double sum = 0;
  double squares = 0;
  double products = 0;
  double count = 0;
  double before = 0;
  for (int y = 0; y < truth.height; ++y) {
    for (int x = 0; x < truth.width; ++x) {
      const auto k = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.width) +
                          static_cast<std::size_t>(x));
      const double difference = picture.pixels[k] - truth.pixels[k];
      sum += difference;
      squares += difference * difference;
      products += x > 0 ? difference * before : 0;
      count += truth.pixels[k + 3] > 0 ? 1 : 0;
      before = difference;
    }
  }
  const double deviation = std::sqrt(squares / count);
  return {products / squares, sum / count / deviation, deviation};
}

class Jitter : public testing::TestWithParam<bool>
{};

TEST_P(Jitter, LeavesNoiseInsteadOfBands)
{
  inr::Renderer renderer = FieldRenderer(Dims, Radius, {}, 2, GetParam());
  renderer.setTransferFunction(Shells());
  inr::Frame frame = ParallelFrame(128, {20, 20}, {30, 30}, -10, 100);
  frame.levelOfDetailScale = 0;
  frame.adaptiveSampling = false;
  frame.sampleDistance = 1.0 / 16;
  const inr::Image truth = Render(renderer, frame);
  frame.sampleDistance = 2;
  const inr::Image coarse = Render(renderer, frame);
  const Residual residual = Compare(coarse, truth);
  EXPECT_GT(residual.deviation, 0.001);
  EXPECT_LT(std::abs(residual.correlation), 0.1);
  EXPECT_LT(std::abs(residual.mean), 0.1);
  frame.frameIndex = 1;
  EXPECT_GT(Compare(Render(renderer, frame), coarse).deviation, residual.deviation)
      << "the noise of two frames in a row is alike";
}

INSTANTIATE_TEST_SUITE_P(Both, Jitter, testing::Values(false, true), [](const auto& info) {
  return std::string(info.param ? "Cached" : "Network");
});

} // namespace test::jitter
