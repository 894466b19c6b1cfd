// SPDX-License-Identifier: BSD-3-Clause
//
// Updates of layers by every kernel against the formulas in float64.
#include "Core/Random.h"
#include "Core/Training/Descent/TrainKernel.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/Training/MatrixTruth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace test::orthogonal_update {

constexpr float Kept = 0.95f;
constexpr float Rate = 0.02f;

/// A layer in training, of random numbers.
struct Layer
{
  Layer(int rowCount, int columnCount, float gradientSize = 1.0f)
      : rows(rowCount), columns(columnCount)
  {
    const auto count = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns);
    for (std::uint64_t k = 0; k < count; ++k) {
      this->parameters.push_back(inr::RandomUnit(1, k) - 0.5f);
      this->gradients.push_back(gradientSize * (inr::RandomUnit(2, k) - 0.4f));
      this->momentum.push_back(gradientSize * (inr::RandomUnit(3, k) - 0.5f));
    }
  }

  void update(const std::string& kernel)
  {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(kernel));
    std::vector<float> workspace(
        static_cast<std::size_t>(train.orthogonalWorkspace(this->rows, this->columns)), NAN);
    train.orthogonal({this->parameters.data(), this->gradients.data(), this->momentum.data(),
                      this->rows, this->columns, Kept, Rate},
                     workspace.data());
  }

  /// What was taken from the parameters, over the rate.
  Matrix stepFrom(const Layer& before) const
  {
    Matrix step(this->rows, this->columns);
    for (std::size_t k = 0; k < step.values.size(); ++k) {
      step.values[k] = (double(before.parameters[k]) - double(this->parameters[k])) / Rate;
    }
    return step;
  }

  int rows, columns;
  std::vector<float> parameters, gradients, momentum;
};

/// Gradient and momentum after it has entered, in the shares that make up the step.
Matrix DirectionOf(const Layer& layer)
{
  Matrix direction(layer.rows, layer.columns);
  for (std::size_t k = 0; k < direction.values.size(); ++k) {
    const double gradient = layer.gradients[k];
    const double momentum = 0.95 * layer.momentum[k] + 0.05 * gradient;
    direction.values[k] = 0.05 * gradient + 0.95 * momentum;
  }
  return direction;
}

void ExpectEqual(const Matrix& found, const Matrix& expected, double tolerance)
{
  for (std::size_t k = 0; k < found.values.size(); ++k) {
    ASSERT_NEAR(found.values[k], expected.values[k], tolerance) << k;
  }
}

constexpr std::pair<int, int> Shapes[] = {{64, 64}, {64, 32},   {64, 160}, {1, 64}, {64, 1},
                                          {1, 1},   {128, 128}, {16, 5},   {7, 21}, {33, 40}};

TEST(OrthogonalUpdate, IsThatOfTheFormulas)
{
  for (const std::string& kernel : UsableKernels()) {
    for (const auto& [rows, columns] : Shapes) {
      SCOPED_TRACE(kernel + ", " + std::to_string(rows) + " x " + std::to_string(columns));
      const Layer before(rows, columns);
      Layer after = before;
      after.update(kernel);
      ExpectEqual(after.stepFrom(before), NearlyOrthogonal(DirectionOf(before)), 1e-4);
      for (std::size_t k = 0; k < after.momentum.size(); ++k) {
        ASSERT_NEAR(after.momentum[k], 0.95 * before.momentum[k] + 0.05 * before.gradients[k],
                    1e-7);
      }
      EXPECT_EQ(after.gradients, before.gradients);
    }
  }
}

/// Without the formulas: along any input the step is about as long as the input, though the
/// gradient is a hundred times as long along some as along others.
TEST(OrthogonalUpdate, GoesAsFarInEveryDirection)
{
  constexpr int size = 48;
  for (const std::string& kernel : UsableKernels()) {
    Layer before(size, size);
    std::fill(before.momentum.begin(), before.momentum.end(), 0.0f);
    for (int row = 0; row < size; ++row) {
      for (int column = 0; column < size; ++column) {
        float& gradient = before.gradients[static_cast<std::size_t>(row * size + column)];
        gradient = (gradient - 0.1f) * 0.01f + (row == column ? std::exp2(row % 7) : 0.0f);
      }
    }
    Layer after = before;
    after.update(kernel);
    const Matrix step = after.stepFrom(before);
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
      Matrix input(size, 1);
      for (std::size_t k = 0; k < size; ++k) {
        input.values[k] = inr::RandomUnit(100 + seed, k) - 0.5;
      }
      const double longer = Length(Product(step, input)) / Length(input);
      EXPECT_GT(longer, 0.65);
      EXPECT_LT(longer, 1.22);
    }
    for (int row = 0; row < size; ++row) { // downhill
      EXPECT_GT(step(row, row), 0.6);
    }
  }
}

TEST(OrthogonalUpdate, DoesNotDependOnTheGradientsSize)
{
  for (const std::string& kernel : UsableKernels()) {
    const Layer before(24, 40);
    Layer expected = before;
    expected.update(kernel);
    for (const float size : {1e-36f, 1e-20f, 1e20f, 1e38f}) {
      const Layer scaled(24, 40, size);
      Layer after = scaled;
      after.update(kernel);
      ExpectEqual(after.stepFrom(scaled), expected.stepFrom(before), 1e-4);
    }
  }
}

/// However long it goes on: momentum that is left would make steps of full length for ever.
TEST(OrthogonalUpdate, MovesNothingWithoutAGradient)
{
  for (const std::string& kernel : UsableKernels()) {
    Layer before(24, 40);
    std::fill(before.gradients.begin(), before.gradients.end(), 0.0f);
    before.gradients[5] = -0.0f;
    Layer after = before;
    for (int k = 0; k < 3000; ++k) {
      after.update(kernel);
    }
    EXPECT_EQ(after.parameters, before.parameters);
    EXPECT_LT(*std::max_element(after.momentum.begin(), after.momentum.end()), 1e-40f);
    std::fill(after.momentum.begin(), after.momentum.end(), 0.0f);
    after.gradients[5] = 1e-45f; // of which nothing is left in the momentum
    after.update(kernel);
    EXPECT_EQ(after.parameters, before.parameters);
  }
}

TEST(OrthogonalUpdate, FindsASingleElement)
{
  for (const std::string& kernel : UsableKernels()) {
    for (const std::size_t place : {0, 1, 17, 38, 39, 920, 959}) {
      Layer before(24, 40, 0.0f);
      before.gradients[place] = -1e-3f;
      Layer after = before;
      after.update(kernel);
      ExpectEqual(after.stepFrom(before), NearlyOrthogonal(DirectionOf(before)), 1e-5);
    }
  }
}

/// A neuron that is off for every sample, or an input that there is none for.
TEST(OrthogonalUpdate, LeavesRowsAndColumnsWithoutAGradient)
{
  constexpr int rows = 24;
  constexpr int columns = 40;
  const auto isOff = [](std::size_t k) {
    return k / columns == 7 || k / columns == rows - 1 || k % columns == 30;
  };
  for (const std::string& kernel : UsableKernels()) {
    for (const float momentum : {0.0f, 1e-25f}) {
      Layer before(rows, columns);
      for (std::size_t k = 0; k < before.gradients.size(); ++k) {
        before.gradients[k] = isOff(k) ? 0.0f : before.gradients[k];
        before.momentum[k] = isOff(k) ? momentum : before.momentum[k];
      }
      Layer after = before;
      after.update(kernel);
      for (std::size_t k = 0; k < before.gradients.size(); ++k) {
        ASSERT_EQ(after.parameters[k] == before.parameters[k], isOff(k)) << k;
      }
    }
  }
}

/// So that the next loss tells.
TEST(OrthogonalUpdate, MakesAllOfALayerNoNumbersWhereOneIsNone)
{
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto isNone = [](float value) { return !std::isfinite(value); };
  for (const std::string& kernel : UsableKernels()) {
    for (const float bad : {NAN, infinity, -infinity}) {
      for (const std::size_t place : {0, 15, 39, 24 * 40 - 1}) {
        Layer layer(24, 40);
        layer.gradients[place] = bad;
        layer.update(kernel);
        EXPECT_TRUE(std::all_of(layer.parameters.begin(), layer.parameters.end(), isNone));
      }
      Layer layer(24, 40);
      std::fill(layer.gradients.begin(), layer.gradients.end(), bad);
      layer.update(kernel);
      EXPECT_TRUE(std::all_of(layer.parameters.begin(), layer.parameters.end(), isNone));
    }
  }
}

} // namespace test::orthogonal_update
