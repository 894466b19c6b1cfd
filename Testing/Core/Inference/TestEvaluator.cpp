// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Inference/HugePages.h"
#include "Testing/Core/Inference/EvaluatePoints.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test::evaluator {

TEST(Evaluator, ValueDoesNotDependOnTheBatch)
{
  const std::vector<glm::vec3> positions = RandomPositions(333);
  for (const std::string& kernel : UsableKernels()) {
    const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()), kernel);
    const std::vector<float> together = Evaluate(*evaluator, positions);
    for (std::size_t k = 0; k < positions.size(); ++k) {
      ASSERT_EQ(Evaluate(*evaluator, {positions[k]})[0], together[k]) << kernel << " at " << k;
    }
  }
}

TEST(Evaluator, ParallelEqualsSerial)
{
  const std::vector<glm::vec3> positions = RandomPositions(20000);
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  const std::vector<float> serial = Evaluate(*evaluator, positions);
  for (const int threads : {1, 2, 5}) {
    std::vector<float> values(positions.size());
    inr::EvaluateParallel(*evaluator, inr::Arena(threads), positions.data(), 20000, values.data());
    EXPECT_EQ(values, serial) << threads;
  }
}

TEST(Evaluator, LatticeSitsAtVoxelCentres)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  const glm::i64vec3 dims(11, 7, 5);
  std::vector<float> block(2 * 3 * 4);
  inr::EvaluateLattice(*evaluator, inr::Arena(2), inr::VoxelLattice(dims, {4, 2, 1}, {2, 3, 4}),
                       block.data());
  // Voxel (5, 4, 3): the second, third and third of the block.
  const glm::vec3 centre(5.5 / 11, 4.5 / 7, 3.5 / 5);
  EXPECT_NEAR(block[1 + 2 * (2 + 3 * 2)], Evaluate(*evaluator, {centre})[0], 1e-5);
}

/// Rows that are cut, layers that take several tasks, several layers to a task, and nothing.
TEST(Evaluator, LatticesAreTheSameHoweverTheyAreShared)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  for (const glm::i64vec3& points :
       {glm::i64vec3(5000, 3, 2), {101, 90, 3}, {3, 5, 600}, {1, 1, 9}, {0, 4, 4}}) {
    const inr::Lattice lattice{glm::dvec3(0.01, 0.02, 0.03), 0.9 / glm::dvec3(points), points};
    std::vector<float> axes[3];
    for (int axis = 0; axis < 3; ++axis) {
      for (std::int64_t k = 0; k < points[axis]; ++k) {
        axes[axis].push_back(
            static_cast<float>(lattice.first[axis] + static_cast<double>(k) * lattice.step[axis]));
      }
    }
    std::vector<float> whole(axes[0].size() * axes[1].size() * axes[2].size());
    if (!whole.empty()) {
      evaluator->evaluateGrid(axes, whole.data());
    }
    for (const int threads : {1, 3}) {
      std::vector<float> values(whole.size());
      inr::EvaluateLattice(*evaluator, inr::Arena(threads), lattice, values.data());
      EXPECT_EQ(values, whole) << points.x << " " << threads;
    }
  }
}

TEST(Evaluator, LatticesOutsideAreClamped)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [first, step] : {std::pair{-3.0, 0.0}, {-0.5, 0.3}, {0.9, 5.0}, {nan, 0.1}}) {
    std::vector<float> values(4);
    inr::EvaluateLattice(*evaluator, inr::Arena(1), {{first, 0.5, 0.5}, {step, 0, 0}, {4, 1, 1}},
                         values.data());
    for (int k = 0; k < 4; ++k) {
      const auto u = static_cast<float>(first + k * step);
      const float expected = Evaluate(*evaluator, {{u, 0.5f, 0.5f}})[0];
      EXPECT_NEAR(values[static_cast<std::size_t>(k)], expected, 1e-6) << first << " " << k;
    }
  }
}

TEST(Evaluator, PositionsOutsideAreClamped)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  const std::vector<float> values =
      Evaluate(*evaluator, {{-1e30f, 0.5f, 0.5f}, {0, 0.5f, 0.5f}, {0.5f, 1e30f, 2}, {0.5f, 1, 1}});
  EXPECT_EQ(values[0], values[1]);
  EXPECT_EQ(values[2], values[3]);
}

TEST(Evaluator, NonFinitePositionsAreHarmless)
{
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const std::string& kernel : UsableKernels()) {
    const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()), kernel);
    for (const float value : Evaluate(*evaluator, {{nan, 0, 0}, {0, infinity, -infinity}})) {
      EXPECT_TRUE(std::isfinite(value)) << kernel;
    }
  }
}

TEST(Evaluator, KernelsAgree)
{
  const std::vector<glm::vec3> positions = RandomPositions(1000);
  const auto model = RandomModel(SmallDescription());
  const std::vector<float> best = Evaluate(*inr::MakeEvaluator(model), positions);
  for (const std::string& kernel : UsableKernels()) {
    const std::vector<float> values = Evaluate(*inr::MakeEvaluator(model, kernel), positions);
    for (std::size_t k = 0; k < values.size(); ++k) {
      ASSERT_NEAR(values[k], best[k], 2e-4f) << kernel; // outputs of this model span about +-20
    }
  }
}

/// A model whose finer levels are too large for a core's own cache: their entries are fetched
/// ahead.
TEST(Evaluator, LargeTablesGiveTheSameInAnyBatch)
{
  inr::Description description = SmallDescription();
  description.grid.log2HashmapSize = 16;
  description.grid.baseResolution = 60;
  const std::vector<glm::vec3> positions = RandomPositions(333);
  for (const std::string& kernel : UsableKernels()) {
    const auto evaluator = inr::MakeEvaluator(RandomModel(description), kernel);
    const std::vector<float> together = Evaluate(*evaluator, positions);
    for (std::size_t k = 0; k < positions.size(); k += 7) {
      ASSERT_EQ(Evaluate(*evaluator, {positions[k]})[0], together[k]) << kernel << " at " << k;
    }
    const std::vector<float> axes[3] = {{0.1f, 0.11f, 0.7f}, {0.2f, 0.3f, 0.31f, 0.9f}, {0.5f}};
    std::vector<float> lattice(12);
    evaluator->evaluateGrid(axes, lattice.data());
    for (std::size_t k = 0; k < lattice.size(); ++k) {
      const glm::vec3 at(axes[0][k % 3], axes[1][k / 3], axes[2][0]);
      ASSERT_NEAR(lattice[k], Evaluate(*evaluator, {at})[0], 2e-4f) << kernel << " at " << k;
    }
  }
}

/// A random model, all of it times `scale`.
std::shared_ptr<inr::Model> ScaledModel(float scale)
{
  auto model = RandomModel(SmallDescription());
  for (float& parameter : model->parameters) {
    parameter *= scale;
  }
  return model;
}

/// None overflows, and what underflows in one kernel does so in all.
TEST(Evaluator, KernelsAgreeOnHugeAndTinyNumbers)
{
  const std::vector<glm::vec3> positions = RandomPositions(500);
  for (const float scale : {1e-38f, 1e-15f, 1e-6f, 1e6f, 1e15f, 1e38f}) {
    const auto model = ScaledModel(scale);
    const std::vector<float> best = Evaluate(*inr::MakeEvaluator(model), positions);
    float largest = 0;
    for (const float value : best) {
      ASSERT_TRUE(std::isfinite(value)) << scale;
      largest = std::max(largest, std::abs(value));
    }
    for (const std::string& kernel : UsableKernels()) {
      const std::vector<float> values = Evaluate(*inr::MakeEvaluator(model, kernel), positions);
      for (std::size_t k = 0; k < values.size(); ++k) {
        ASSERT_NEAR(values[k], best[k], 1e-5f * largest) << kernel << " at " << scale;
      }
    }
  }
}

/// A sum that overflows to minus infinity is cut off by ReLU like any other negative one.
TEST(Evaluator, ReluCutsOffMinusInfinity)
{
  inr::Description description = SmallDescription();
  description.network.hiddenLayers = 1;
  auto model = RandomModel(description);
  const inr::Layout layout(description);
  std::fill(model->parameters.begin(), model->parameters.end(), 0.0f);
  std::fill(model->parameters.begin() + static_cast<std::ptrdiff_t>(layout.gridOffset),
            model->parameters.end(), 1e20f);
  const auto columns = static_cast<std::size_t>(layout.layers[0].columns);
  model->parameters[0] = -1e20f;       // neuron 0 sees -1e40
  model->parameters[columns] = 1e-20f; // neuron 1 sees 1
  model->parameters[layout.layers[1].offset] = 1.0f;
  model->parameters[layout.layers[1].offset + 1] = 0.5f;
  for (const std::string& kernel : UsableKernels()) {
    for (const float value : Evaluate(*inr::MakeEvaluator(model, kernel), RandomPositions(50))) {
      ASSERT_NEAR(value, 0.5f, 1e-5f) << kernel;
    }
  }
}

TEST(HugePages, LeaveWhatIsThere)
{
  std::vector<std::size_t> numbers(std::size_t{3} << 20);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    numbers[k] = k;
  }
  inr::PreferHugePages(numbers.data() + 1, (numbers.size() - 1) * sizeof(numbers[0]));
  inr::PreferHugePages(numbers.data(), 8);
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    ASSERT_EQ(numbers[k], k);
  }
}

TEST(Evaluator, NeedsAModel)
{
  EXPECT_THROW(inr::MakeEvaluator(nullptr), inr::Error);
  EXPECT_THROW(
      inr::MakeEvaluator(nullptr, inr::ChooseKernels("", inr::InferencePrecision::Float32)),
      inr::Error);
}

TEST(Evaluator, RefusesAWrongParameterCount)
{
  auto model = RandomModel(SmallDescription());
  model->parameters.pop_back();
  EXPECT_THROW(inr::MakeEvaluator(model), inr::Error);
}

TEST(Evaluator, RefusesParametersThatAreNotNumbers)
{
  for (const float bad : {NAN, std::numeric_limits<float>::infinity()}) {
    auto model = RandomModel(SmallDescription());
    model->parameters[77] = -bad;
    try {
      inr::MakeEvaluator(model);
      FAIL() << "took " << bad;
    } catch (const inr::Error& error) {
      EXPECT_EQ(error.code(), inr::ErrorCode::InvalidModel);
      EXPECT_NE(std::string(error.what()).find("77"), std::string::npos) << error.what();
    }
  }
}

TEST(Evaluator, NamesItsKernelAndRefusesUnknownOnes)
{
  for (const std::string& kernel : UsableKernels()) {
    EXPECT_EQ(inr::MakeEvaluator(RandomModel(SmallDescription()), kernel)->kernel(), kernel);
  }
  EXPECT_THROW(inr::MakeEvaluator(RandomModel(SmallDescription()), "abacus"), inr::Error);
}

} // namespace test::evaluator
