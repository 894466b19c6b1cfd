// SPDX-License-Identifier: BSD-3-Clause
//
// Every kernel against truth.py, an independent float64 evaluation.
#include "Core/Inference/Evaluator.h"
#include "Core/Random.h"
#include "Testing/Core/Inference/TruthCase.h"
#include "Testing/Core/Kernels.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::truth {

/// Largest difference to the truth, relative to the truth's range.
double Error(const TruthCase& truth, const std::string& kernel)
{
  const auto evaluator =
      inr::MakeEvaluator(std::make_shared<const inr::Model>(truth.Source), kernel);
  std::vector<float> values(truth.Positions.size());
  evaluator->evaluate(truth.Positions.data(), static_cast<std::int64_t>(values.size()),
                      values.data());
  double largest = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    largest = std::max(largest, std::abs(values[k] - truth.Values[k]));
  }
  const auto range = std::minmax_element(truth.Values.begin(), truth.Values.end());
  return largest / (*range.second - *range.first);
}

TEST(Truth, CoversEveryKindOfModel) { EXPECT_GE(CaseNames().size(), 20u); }

TEST(Truth, FloatParametersAgreeTo1e5OfTheRange)
{
  for (const std::string& name : CaseNames()) {
    const TruthCase truth(name);
    ASSERT_GE(truth.Values.size(), 500u) << name;
    for (const std::string& kernel : UsableKernels()) {
      EXPECT_LT(Error(truth, kernel), 1e-5) << name << " with " << kernel;
    }
  }
}

/// Rising coordinates, some of them on cell faces and at the ends of the unit cube.
std::vector<float> Axis(std::size_t count, std::uint64_t seed)
{
  std::vector<float> axis(count);
  for (std::size_t k = 0; k < count; ++k) {
    axis[k] =
        k % 3 == 0 ? static_cast<float>(k) / static_cast<float>(count) : inr::RandomUnit(seed, k);
  }
  axis.front() = 0.0f;
  axis.back() = 1.0f;
  std::sort(axis.begin(), axis.end());
  return axis;
}

TEST(Truth, ALatticeAgreesWithItsPoints)
{
  const std::vector<float> axes[3] = {Axis(131, 1), Axis(9, 2), Axis(4, 3)};
  std::vector<glm::vec3> points;
  for (const float z : axes[2]) {
    for (const float y : axes[1]) {
      for (const float x : axes[0]) {
        points.emplace_back(x, y, z);
      }
    }
  }
  for (const std::string& name : CaseNames()) {
    const auto model = std::make_shared<const inr::Model>(TruthCase(name).Source);
    for (const std::string& kernel : UsableKernels()) {
      const auto evaluator = inr::MakeEvaluator(model, kernel);
      std::vector<float> expected(points.size());
      evaluator->evaluate(points.data(), static_cast<std::int64_t>(points.size()), expected.data());
      std::vector<float> values(points.size());
      evaluator->evaluateGrid(axes, values.data());
      const auto range = std::minmax_element(expected.begin(), expected.end());
      float largest = 0;
      for (std::size_t k = 0; k < values.size(); ++k) {
        largest = std::max(largest, std::abs(values[k] - expected[k]));
      }
      EXPECT_LT(largest, 1e-5f * (*range.second - *range.first)) << name << " with " << kernel;
    }
  }
}

TEST(Truth, HalfParametersAgreeTo2e3OfTheRange)
{
  for (const std::string& name : CaseNames()) {
    TruthCase truth(name);
    for (float& parameter : truth.Source.parameters) {
      parameter = static_cast<float>(Imath::half(parameter));
    }
    for (const std::string& kernel : UsableKernels()) {
      EXPECT_LT(Error(truth, kernel), 2e-3) << name << " with " << kernel;
    }
  }
}

} // namespace test::truth
