// SPDX-License-Identifier: BSD-3-Clause
//
// Every kernel that computes with bfloat16 numbers against an evaluation in long double.
#include "Core/Inference/ModelView.h"
#include "Testing/Core/Inference/EvaluatePoints.h"
#include "Testing/Core/Inference/OddShapes.h"
#include "Testing/Core/Inference/RoundingKernels.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace test::b_float16 {

class BFloat16 : public testing::Test
{
protected:
  void SetUp() override
  {
    if (this->Kernels.empty()) {
      GTEST_SKIP() << "this processor multiplies no bfloat16 numbers";
    }
  }

  const RoundingKernels Kernels;
};

TEST_F(BFloat16, IsOffByNoMoreThanItsRounding)
{
  const std::vector<glm::vec3> positions = RandomPositions(500);
  for (const inr::Description& description : OddShapes()) {
    const inr::ModelPointer model = CalmModel(description);
    const std::vector<float> unrounded = Evaluate(*inr::MakeEvaluator(model), positions);
    for (const inr::InferenceKernels& kernels : this->Kernels) {
      std::vector<Bounded> exact(positions.size());
      const LongDoubleTruth truth(*model, ProductsOf(kernels));
      std::transform(positions.begin(), positions.end(), exact.begin(), truth);
      const std::vector<float> values = Evaluate(*inr::MakeEvaluator(model, kernels), positions);
      int others = 0;
      for (std::size_t k = 0; k < values.size(); ++k) {
        ASSERT_LE(std::abs(values[k] - exact[k].value), exact[k].error) << kernels.name << k;
        others += values[k] != unrounded[k] ? 1 : 0;
      }
      EXPECT_GT(others, 450) << "is that float32? " << kernels.name;
    }
  }
}

TEST_F(BFloat16, IsTheSameOnLatticesButForRounding)
{
  std::vector<float> axes[3];
  for (int k = 0; k < 43; ++k) { // no whole pieces
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes[axis].resize(std::min<std::size_t>(axes[axis].size() + 1, 43 - 20 * axis));
      axes[axis].back() = static_cast<float>(axes[axis].size()) / 50;
    }
  }
  for (const inr::Description& description : OddShapes()) {
    const inr::ModelPointer model = CalmModel(description);
    std::vector<float> values(axes[0].size() * axes[1].size() * axes[2].size());
    for (const inr::InferenceKernels& kernels : this->Kernels) {
      const LongDoubleTruth truth(*model, ProductsOf(kernels));
      inr::MakeEvaluator(model, kernels)->evaluateGrid(axes, values.data());
      for (std::size_t k = 0; k < values.size(); k += 29) {
        const glm::vec3 at(axes[0][k % axes[0].size()],
                           axes[1][k / axes[0].size() % axes[1].size()],
                           axes[2][k / (axes[0].size() * axes[1].size())]);
        const Bounded exact = truth(at);
        ASSERT_LE(std::abs(values[k] - exact.value), exact.error) << kernels.name << k;
      }
    }
  }
}

void ExpectNoNeighbours(const inr::Evaluator& evaluator, const std::vector<glm::vec3>& positions)
{
  const std::vector<float> together = Evaluate(evaluator, positions);
  for (std::size_t k = 0; k < positions.size(); ++k) {
    ASSERT_EQ(Evaluate(evaluator, {positions[k]})[0], together[k]) << evaluator.kernel() << k;
  }
  const std::vector<float> axes[3] = {{0.1f, 0.11f, 0.7f}, {0.2f, 0.3f, 0.31f, 0.9f}, {0.5f}};
  std::vector<float> lattice(12);
  evaluator.evaluateGrid(axes, lattice.data());
  for (std::size_t k = 0; k < lattice.size(); ++k) {
    float alone = 0;
    const std::vector<float> point[3] = {{axes[0][k % 3]}, {axes[1][k / 3]}, {axes[2][0]}};
    evaluator.evaluateGrid(point, &alone);
    ASSERT_EQ(lattice[k], alone) << evaluator.kernel() << k;
  }
}

TEST_F(BFloat16, ValuesDoNotDependOnTheirNeighbours)
{
  const std::vector<glm::vec3> positions = RandomPositions(107);
  for (const inr::Description& description : OddShapes()) {
    for (const inr::InferenceKernels& kernels : this->Kernels) {
      ExpectNoNeighbours(*inr::MakeEvaluator(CalmModel(description), kernels), positions);
    }
  }
}

TEST_F(BFloat16, IsForModelsWhoseNumbersCannotOverflow)
{
  const bool tiles = inr::IsTileKernelUsable();
  const std::pair<inr::InferencePrecision, std::string> kernels[] = {
      {inr::InferencePrecision::BFloat16, tiles ? "amx bfloat16" : "avx512 bfloat16"},
      {inr::InferencePrecision::SplitBFloat16, tiles ? "amx split bfloat16" : "avx512"}};
  auto huge = RandomModel(SmallDescription());
  for (float& parameter : huge->parameters) {
    parameter *= 1e12f;
  }
  const std::vector<glm::vec3> positions = RandomPositions(50);
  for (const auto& [precision, kernel] : kernels) {
    const auto calm = CalmModel(SmallDescription());
    EXPECT_EQ(inr::MakeEvaluator(calm, "", precision)->kernel(), kernel);
    const auto evaluator = inr::MakeEvaluator(huge, "", precision);
    EXPECT_EQ(evaluator->kernel(), "avx512");
    EXPECT_EQ(Evaluate(*evaluator, positions), Evaluate(*inr::MakeEvaluator(huge), positions));
  }
}

/// Of values of a thousand the same digits are off by more.
TEST_F(BFloat16, OfTwoPartsIsForModelsThatItRoundsLittle)
{
  auto model = CalmModel(SmallDescription());
  for (std::size_t k = inr::Layout(model->description).gridOffset; k < model->parameters.size();
       ++k) {
    model->parameters[k] *= 1000;
  }
  const auto evaluator = inr::MakeEvaluator(model, "", inr::InferencePrecision::SplitBFloat16);
  EXPECT_EQ(evaluator->kernel(), "avx512");
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
bool StaysInRange(inr::Activation activation, float feature, float weight, int hiddenLayers = 2)
{
  inr::Description description = SmallDescription();
  description.network.activation = activation;
  description.network.hiddenLayers = hiddenLayers;
  const inr::Layout layout(description);
  std::vector<float> parameters(layout.parameterCount, weight);
  const auto grid = parameters.begin() + static_cast<std::ptrdiff_t>(layout.gridOffset);
  std::fill(grid, parameters.end(), feature); // the grid's are the last
  return inr::StaysInRange(inr::ModelViewStorage(description, layout, parameters.data()).view());
}

/// Layers have 16 columns; 2^120 is too large.
TEST(InferencePrecision, KnowsHowLargeNumbersBecome)
{
  using inr::Activation;
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 1e5f, 1e5f));
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 5e14f, 1e20f, 0));
  EXPECT_FALSE(StaysInRange(Activation::ReLU, -1e15f, 1e20f, 0));
  EXPECT_FALSE(StaysInRange(Activation::ReLU, 1e15f, -1e20f, 0));
  EXPECT_FALSE(StaysInRange(Activation::ReLU, 1e-30f, 3e38f)); // rounds to infinity
  EXPECT_FALSE(StaysInRange(Activation::Tanh, 3e37f, 1.0f));
  EXPECT_TRUE(StaysInRange(Activation::Tanh, 1e10f, 1e5f));
  EXPECT_TRUE(StaysInRange(Activation::Exponential, 1.0f, 0.01f));
  EXPECT_FALSE(StaysInRange(Activation::Exponential, 6.0f, 1.0f));
}

/// What is below 2^-126 counts as zero, and that may come to 2^-30.
TEST(InferencePrecision, KnowsWhatIsLostToZero)
{
  using inr::Activation;
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 1e-40f, 1.0f));
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 1e-40f, 0x1p26f)); // of features: 2^-126 * (16 w)^3
  EXPECT_FALSE(StaysInRange(Activation::ReLU, 1e-40f, 0x1p29f));
  EXPECT_TRUE(StaysInRange(Activation::ReLU, 0x1p91f, 1e-40f, 0)); // of weights: 2^-126 * 16 f
  EXPECT_FALSE(StaysInRange(Activation::ReLU, 0x1p93f, 1e-40f, 0));
  EXPECT_TRUE(StaysInRange(Activation::Exponential, 1e-40f, 0.1f));
  EXPECT_FALSE(StaysInRange(Activation::Exponential, 4.0f, 1.0f)); // times e^64
}

TEST(InferencePrecision, RoundsPairsOfWeightsToNearestAndEven)
{
  const float weights[3 * 3] = {1.0f + 0x1p-8f, -3.0f, 1.0f + 3 * 0x1p-8f, // row by row
                                0.1f,           0.0f,  -0x1p-130f,         1.0f, 2.0f, 4.0f};
  const inr::LayerView layer{weights, 3, 3, nullptr, nullptr};
  inr::ModelView model{};
  model.layers = &layer;
  model.layerCount = 1;
  const inr::PackedNetwork network(model, inr::WeightLayout::Pairs);
  const std::uint32_t* pairs = network.view().layers[0].pairs;
  EXPECT_EQ(pairs[0], 0xc0403f80u); // -3 and 1, of two as near the even one
  EXPECT_EQ(pairs[1], 0x00003dcdu); // 0 and 0.1, a little more
  EXPECT_EQ(pairs[2], 0x40003f80u);
  EXPECT_EQ(pairs[3], 0u);                       // there is no fourth row
  EXPECT_EQ(pairs[inr::PanelRows], 0x00003f82u); // nothing beside the last column
  EXPECT_EQ(pairs[inr::PanelRows + 2], 0x00004080u);
}

} // namespace test::b_float16
