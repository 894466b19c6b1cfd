// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/ModelView.h"
#include "Testing/Core/Inference/EvaluatePoints.h"
#include "Testing/Core/Inference/LongDoubleTruth.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

constexpr long double Rounding = 0x1p-9L;

/// Widths that no pair, panel or vector of the kernels divides, and activations that go through
/// memory or leave no zeros.
std::vector<inr::Description> Descriptions()
{
  std::vector<inr::Description> all(4, SmallDescription());
  all[1].grid.levels = 5;
  all[1].grid.features = 1;
  all[1].network.activation = inr::Activation::Tanh;
  all[2].grid.features = 8;
  all[2].network.neurons = 64;
  all[2].network.hiddenLayers = 3;
  all[3].network.activation = inr::Activation::None;
  all[3].network.outputActivation = inr::Activation::LeakyReLU;
  return all;
}

/// Its sums stay about as large as its features.
inr::ModelPointer CalmModel(const inr::Description& description)
{
  auto model = RandomModel(description);
  const inr::Layout layout(description);
  for (const inr::LayerShape& layer : layout.layers) {
    const auto begin = model->parameters.begin() + static_cast<std::ptrdiff_t>(layer.offset);
    std::for_each(begin, begin + std::ptrdiff_t{layer.rows} * layer.columns,
                  [&](float& weight) { weight *= 2.0f / std::sqrt(float(layer.columns)); });
  }
  return model;
}

std::shared_ptr<const inr::Evaluator> Rounded(const inr::ModelPointer& model)
{
  return inr::MakeEvaluator(model, "", inr::InferencePrecision::BFloat16);
}

class BFloat16 : public testing::Test
{
protected:
  void SetUp() override
  {
    if (!inr::IsUsable(inr::InferencePrecision::BFloat16, inr::InstructionSet::Avx512)) {
      GTEST_SKIP() << "this processor multiplies no bfloat16 numbers";
    }
  }
};

TEST_F(BFloat16, IsOffByNoMoreThanItsRounding)
{
  const std::vector<glm::vec3> positions = RandomPositions(500);
  for (const inr::Description& description : Descriptions()) {
    const inr::ModelPointer model = CalmModel(description);
    const LongDoubleTruth truth(*model, Rounding);
    const std::vector<float> values = Evaluate(*Rounded(model), positions);
    const std::vector<float> unrounded = Evaluate(*inr::MakeEvaluator(model), positions);
    int others = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const Bounded exact = truth(positions[k]);
      ASSERT_LE(std::abs(values[k] - exact.value), exact.error) << k;
      others += values[k] != unrounded[k] ? 1 : 0;
    }
    EXPECT_GT(others, 450) << "is that float32?";
  }
}

TEST_F(BFloat16, IsTheSameOnLatticesButForRounding)
{
  std::vector<float> axes[3];
  for (int k = 0; k < 43; ++k) { // no whole pieces
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes[axis].resize(std::min<std::size_t>(axes[axis].size() + 1, 43 - 17 * axis));
      axes[axis].back() = static_cast<float>(axes[axis].size()) / 50;
    }
  }
  for (const inr::Description& description : Descriptions()) {
    const inr::ModelPointer model = CalmModel(description);
    const LongDoubleTruth truth(*model, Rounding);
    std::vector<float> values(axes[0].size() * axes[1].size() * axes[2].size());
    Rounded(model)->evaluateGrid(axes, values.data());
    for (std::size_t k = 0; k < values.size(); k += 5) {
      const glm::vec3 at(axes[0][k % axes[0].size()], axes[1][k / axes[0].size() % axes[1].size()],
                         axes[2][k / (axes[0].size() * axes[1].size())]);
      const Bounded exact = truth(at);
      ASSERT_LE(std::abs(values[k] - exact.value), exact.error) << k;
    }
  }
}

TEST_F(BFloat16, ValuesDoNotDependOnTheirNeighbours)
{
  const std::vector<glm::vec3> positions = RandomPositions(333);
  for (const inr::Description& description : Descriptions()) {
    const auto evaluator = Rounded(CalmModel(description));
    const std::vector<float> together = Evaluate(*evaluator, positions);
    for (std::size_t k = 0; k < positions.size(); ++k) {
      ASSERT_EQ(Evaluate(*evaluator, {positions[k]})[0], together[k]) << k;
    }
    const std::vector<float> axes[3] = {{0.1f, 0.11f, 0.7f}, {0.2f, 0.3f, 0.31f, 0.9f}, {0.5f}};
    std::vector<float> lattice(12);
    evaluator->evaluateGrid(axes, lattice.data());
    for (std::size_t k = 0; k < lattice.size(); ++k) {
      float alone = 0;
      const std::vector<float> point[3] = {{axes[0][k % 3]}, {axes[1][k / 3]}, {axes[2][0]}};
      evaluator->evaluateGrid(point, &alone);
      ASSERT_EQ(lattice[k], alone) << k;
    }
  }
}

TEST_F(BFloat16, IsForModelsWhoseNumbersCannotOverflow)
{
  EXPECT_EQ(Rounded(RandomModel(SmallDescription()))->kernel(), "avx512 bfloat16");
  auto huge = RandomModel(SmallDescription());
  for (float& parameter : huge->parameters) {
    parameter *= 1e12f;
  }
  const auto evaluator = Rounded(huge);
  EXPECT_EQ(evaluator->kernel(), "avx512");
  const std::vector<glm::vec3> positions = RandomPositions(50);
  EXPECT_EQ(Evaluate(*evaluator, positions), Evaluate(*inr::MakeEvaluator(huge), positions));
}

TEST(InferencePrecision, IsFloatWhereTheKernelHasNoOther)
{
  const auto model = RandomModel(SmallDescription());
  for (const std::string& kernel : UsableKernels()) {
    const auto evaluator = inr::MakeEvaluator(model, kernel, inr::InferencePrecision::BFloat16);
    const bool can =
        inr::IsUsable(inr::InferencePrecision::BFloat16, inr::ChooseInstructionSet(kernel));
    EXPECT_EQ(evaluator->kernel(), kernel + (can ? " bfloat16" : ""));
    EXPECT_EQ(inr::MakeEvaluator(model, kernel)->kernel(), kernel);
  }
  EXPECT_FALSE(inr::IsUsable(inr::InferencePrecision::BFloat16, inr::InstructionSet::Avx2));
}

/// Whether a model stays in range with the parameters of a part of it set to a value.
bool StaysInRange(inr::Activation activation, float feature, float weight)
{
  inr::Description description = SmallDescription();
  description.network.activation = activation;
  const inr::Layout layout(description);
  std::vector<float> parameters(layout.parameterCount, weight);
  const auto grid = parameters.begin() + static_cast<std::ptrdiff_t>(layout.gridOffset);
  std::fill(grid, parameters.end(), feature); // the grid's are the last
  return inr::StaysInRange(inr::ModelViewStorage(description, layout, parameters.data()).view());
}

TEST(InferencePrecision, KnowsHowLargeNumbersBecome)
{
  using inr::Activation;
  // Three layers of 16 columns: 4096 times what goes in, and weights three times.
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 1e31f, 1.0f));
  EXPECT_FALSE(StaysInRange(Activation::ReLU, -1e33f, 1.0f));
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 1.0f, 1e10f));
  EXPECT_FALSE(StaysInRange(Activation::ReLU, 1.0f, -1e12f));
  EXPECT_FALSE(StaysInRange(Activation::ReLU, 1e-30f, 3e38f)); // rounds to infinity
  EXPECT_FALSE(StaysInRange(Activation::Tanh, 3e37f, 1.0f));
  EXPECT_TRUE(StaysInRange(Activation::Tanh, 1e29f, 1e5f));
  EXPECT_TRUE(StaysInRange(Activation::Exponential, 1.0f, 0.01f));
  EXPECT_FALSE(StaysInRange(Activation::Exponential, 6.0f, 1.0f));
}

TEST(InferencePrecision, RoundsPairsOfWeightsToNearestAndEven)
{
  const float weights[3 * 3] = {1.0f + 0x1p-8f, -3.0f, 1.0f + 3 * 0x1p-8f, // row by row
                                0.1f,           0.0f,  -0x1p-130f,         1.0f, 2.0f, 4.0f};
  const inr::LayerView layer{weights, 3, 3, nullptr, nullptr};
  inr::ModelView model{};
  model.layers = &layer;
  model.layerCount = 1;
  const inr::PackedNetwork network(model, inr::InferencePrecision::BFloat16);
  const std::uint32_t* pairs = network.view().layers[0].pairs;
  EXPECT_EQ(pairs[0], 0xc0403f80u); // -3 and 1, of two as near the even one
  EXPECT_EQ(pairs[1], 0x00003dcdu); // 0 and 0.1, a little more
  EXPECT_EQ(pairs[2], 0x40003f80u);
  EXPECT_EQ(pairs[3], 0u);                       // there is no fourth row
  EXPECT_EQ(pairs[inr::PanelRows], 0x00003f82u); // nothing beside the last column
  EXPECT_EQ(pairs[inr::PanelRows + 2], 0x00004080u);
}

} // namespace
