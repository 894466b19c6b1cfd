// SPDX-License-Identifier: BSD-3-Clause
//
// The trainer's gradients against finite differences of its own loss.
#include "Core/Training/Descent/AdamSchedule.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"
#include "Testing/Core/Training/MatrixTruth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test::gradients {

constexpr std::int64_t SampleCount = 1000; // not a multiple of any block

/// To either side of the outputs.
std::vector<float> MixedTargets(std::int64_t count)
{
  std::vector<float> targets(static_cast<std::size_t>(count));
  for (std::size_t k = 0; k < targets.size(); ++k) {
    targets[k] = k % 3 == 0 ? 2.0f : -2.0f;
  }
  return targets;
}

struct Problem
{
  Problem(const inr::Description& description, const std::string& kernel,
          std::int64_t count = SampleCount)
      : Threads(2), Descent(description, 1, inr::ChooseInstructionSet(kernel), Threads),
        Positions(RandomPositions(count)), Targets(MixedTargets(count))
  {
    for (std::size_t k = 0; k < this->Descent.parameters().size(); ++k) {
      this->Descent.parameters()[k] = 0.8f * inr::RandomUnit(5, k) - 0.4f;
    }
  }

  double loss() { return *this->Descent.computeGradient(this->Positions, this->Targets); }

  /// Central difference along `direction`.
  double slopeAlong(const std::vector<float>& direction)
  {
    constexpr float step = 2e-3f;
    inr::AlignedVector<float>& parameters = this->Descent.parameters();
    const inr::AlignedVector<float> here = parameters;
    double ends[2];
    for (const int side : {0, 1}) {
      for (std::size_t k = 0; k < here.size(); ++k) {
        parameters[k] = here[k] + (side == 0 ? -step : step) * direction[k];
      }
      ends[side] = this->loss();
    }
    parameters = here;
    return (ends[1] - ends[0]) / (2.0 * step);
  }

  inr::Arena Threads;
  inr::GradientDescent Descent;
  std::vector<glm::vec3> Positions;
  std::vector<float> Targets;
};

/// A random +-1 direction within [begin, end).
std::vector<float> Direction(std::size_t size, std::size_t begin, std::size_t end)
{
  std::vector<float> direction(size, 0.0f);
  for (std::size_t k = begin; k < end; ++k) {
    direction[k] = inr::RandomUnit(9, k) < 0.5f ? -1.0f : 1.0f;
  }
  return direction;
}

void ExpectGradient(const inr::Description& description, const std::string& kernel,
                    const std::string& what, float size = 1.0f, std::int64_t count = SampleCount)
{
  Problem problem(description, kernel, count);
  for (float& parameter : problem.Descent.parameters()) {
    parameter *= size;
  }
  problem.loss();
  const inr::AlignedVector<float> gradient = problem.Descent.gradient();
  const inr::Layout layout(description);
  // The network alone and the grid alone: an error in one must not hide behind the other.
  const std::pair<std::size_t, std::size_t> parts[] = {{0, layout.gridOffset},
                                                       {layout.gridOffset, gradient.size()}};
  for (const auto& [begin, end] : parts) {
    const std::vector<float> direction = Direction(gradient.size(), begin, end);
    double expected = 0;
    double scale = 0;
    for (std::size_t k = begin; k < end; ++k) {
      expected += static_cast<double>(gradient[k]) * direction[k];
      scale += std::abs(static_cast<double>(gradient[k]));
    }
    ASSERT_GT(scale, 0) << what;
    EXPECT_NEAR(problem.slopeAlong(direction), expected, 0.004 * scale + 1e-4)
        << what << " " << kernel;
  }
}

TEST(Gradients, MatchFiniteDifferencesForEveryActivation)
{
  using inr::Activation;
  for (const Activation activation :
       {Activation::None, Activation::ReLU, Activation::LeakyReLU, Activation::Exponential,
        Activation::Sigmoid, Activation::Sine, Activation::Squareplus, Activation::Softplus,
        Activation::Tanh}) {
    inr::Description description = SmallDescription();
    description.network.activation = activation;
    for (const std::string& kernel : UsableKernels()) {
      ExpectGradient(description, kernel,
                     "activation " + std::to_string(static_cast<int>(activation)));
    }
  }
}

TEST(Gradients, MatchForEveryShape)
{
  for (const int features : {1, 2, 4, 8}) {
    for (const int hidden : {0, 1, 3}) {
      inr::Description description = SmallDescription();
      description.grid.features = features;
      description.network.hiddenLayers = hidden;
      description.network.activation = inr::Activation::Tanh;
      description.network.outputActivation = inr::Activation::Sigmoid;
      ExpectGradient(description, "",
                     "features " + std::to_string(features) + " hidden " + std::to_string(hidden));
    }
  }
}

TEST(Gradients, MatchForEveryGrid)
{
  for (const inr::GridType type :
       {inr::GridType::Hash, inr::GridType::Dense, inr::GridType::Tiled}) {
    for (const inr::GridInterpolation interpolation :
         {inr::GridInterpolation::Linear, inr::GridInterpolation::Smoothstep,
          inr::GridInterpolation::Nearest}) {
      inr::Description description = SmallDescription();
      description.grid.type = type;
      description.grid.interpolation = interpolation;
      description.network.activation = inr::Activation::Sigmoid;
      ExpectGradient(description, "", "grid " + std::to_string(static_cast<int>(type)));
    }
  }
}

// Which goes through it in less than a block at a time.
TEST(Gradients, MatchForALargeNetwork)
{
  inr::Description description = SmallDescription();
  description.network.neurons = 1024;
  description.network.hiddenLayers = 3;
  description.network.activation = inr::Activation::Tanh;
  ExpectGradient(description, "", "1024 neurons", 0.1f, 300);
}

TEST(Gradients, UnknownTargetsCarryNone)
{
  Problem problem(SmallDescription(), "");
  std::fill(problem.Targets.begin(), problem.Targets.end(), NAN);
  EXPECT_EQ(problem.loss(), 0.0);
  for (const float component : problem.Descent.gradient()) {
    ASSERT_EQ(component, 0.0f);
  }
}

// Whenever it is stopped, a step that is repeated gives what it would have given.
TEST(GradientDescent, AStoppedStepChangesNothing)
{
  const Field<float> field = WaveField();
  const inr::InMemorySource source(field.data(), -1, 1);
  inr::StratifiedBatches batches(source);
  const inr::Arena threads(2);
  const inr::InstructionSet set = inr::ChooseInstructionSet("");
  inr::GradientDescent expected(SmallDescription(), 1, set, threads);
  expected.step(batches);
  inr::GradientDescent stopped(SmallDescription(), 1, set, threads);
  int stops = 0;
  for (int limit = 1; stopped.steps() == 0; limit += 7) {
    int asked = 0;
    const inr::StopCheck check([&] { return ++asked < limit; });
    stops += stopped.step(batches, check) ? 0 : 1;
  }
  EXPECT_GT(stops, 3);
  EXPECT_EQ(stopped.parameters(), expected.parameters());
}

/// What the network's way back leaves of a block, in a workspace that begins `offset` floats behind
/// a line and is full of `filling`.
struct BlockResult
{
  BlockResult(const std::string& kernel, std::int64_t offset, float filling)
      : Weights(this->Shape.gridOffset), Encoded(this->blockSize(), 0.25f)
  {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(kernel));
    const auto model = CalmModel(this->Description);
    const inr::ModelViewStorage views(this->Description, this->Shape, model->parameters.data());
    const std::vector<float> targets = MixedTargets(Count);
    inr::AlignedVector<float> workspace(
        static_cast<std::size_t>(train.workspace(views.view()) + offset), filling);
    inr::TrainBlock block{targets.data(),       Count, 1.0f, this->Encoded.data(),
                          this->Weights.data(), 0};
    train.backpropagate(views.view(), block, workspace.data() + offset);
    this->Loss = block.loss;
  }

  std::size_t blockSize() const
  {
    return static_cast<std::size_t>(this->Shape.encodedWidth * inr::TrainRowSize);
  }

  static constexpr std::int64_t Count = 100; // fills no vector
  inr::Description Description = SmallDescription();
  inr::Layout Shape{this->Description};
  inr::AlignedVector<float> Weights, Encoded;
  double Loss = 0;
};

TEST(Gradients, DependOnNothingThatAWorkspaceHeld)
{
  for (const std::string& kernel : UsableKernels()) {
    const BlockResult expected(kernel, 0, 0.0f);
    EXPECT_GT(expected.Loss, 0);
    const BlockResult found(kernel, 5, std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(found.Weights, expected.Weights);
    EXPECT_EQ(found.Encoded, expected.Encoded);
    EXPECT_EQ(found.Loss, expected.Loss);
  }
}

/// Of a step in training.
struct StepTaken
{
  inr::AlignedVector<float> before, gradient, after;
};

std::vector<StepTaken> TakeSteps(const inr::Description& description, int count)
{
  const Field<float> field = WaveField();
  const inr::InMemorySource source(field.data(), -1, 1);
  inr::StratifiedBatches batches(source);
  const inr::Arena threads(2);
  inr::GradientDescent descent(description, 1, inr::ChooseInstructionSet(""), threads);
  std::vector<StepTaken> steps;
  for (int k = 0; k < count; ++k) {
    const inr::AlignedVector<float> before = descent.parameters();
    EXPECT_TRUE(descent.step(batches));
    steps.push_back({before, descent.gradient(), descent.parameters()});
  }
  return steps;
}

/// Weights from `first` on, by the number of the step, against float64.
void ExpectAdam(const std::vector<StepTaken>& steps, std::size_t first, std::size_t count)
{
  constexpr double decay = 1e-6;
  const std::vector<inr::AdamStep> updates = inr::AdamUpdates();
  std::vector<double> firstMoment(count);
  std::vector<double> secondMoment(count);
  for (std::size_t t = 1; t <= steps.size(); ++t) {
    const StepTaken& step = steps[t - 1];
    for (std::size_t k = 0; k < count; ++k) {
      const double before = step.before[first + k];
      const double gradient = step.gradient[first + k] + decay * before;
      const double kept = updates[t].beta2;
      firstMoment[k] = 0.9 * firstMoment[k] + 0.1 * gradient;
      secondMoment[k] = kept * secondMoment[k] + (1 - kept) * gradient * gradient;
      const double moved = 0.01 * updates[t].rate * firstMoment[k] / std::sqrt(secondMoment[k]);
      ASSERT_NEAR(step.after[first + k], before - moved, 1e-5) << k << " in step " << t;
    }
  }
}

/// All weights of a layer, against float64.
void ExpectOrthogonalised(const std::vector<StepTaken>& steps, const inr::LayerShape& layer)
{
  Matrix momentum(layer.rows, layer.columns);
  for (std::size_t t = 1; t <= steps.size(); ++t) {
    const StepTaken& step = steps[t - 1];
    const double rate = 0.01 * (t <= 25 ? 8.0 : 40.0 / std::sqrt(t));
    Matrix direction(layer.rows, layer.columns);
    for (std::size_t k = 0; k < direction.values.size(); ++k) {
      const double gradient = step.gradient[layer.offset + k];
      momentum.values[k] = 0.95 * momentum.values[k] + 0.05 * gradient;
      direction.values[k] = 0.95 * momentum.values[k] + 0.05 * gradient;
    }
    const Matrix expected = NearlyOrthogonal(direction);
    for (std::size_t k = 0; k < expected.values.size(); ++k) {
      const double moved = rate * expected.values[k];
      ASSERT_NEAR(step.after[layer.offset + k], step.before[layer.offset + k] - moved, 1e-5) << k;
    }
  }
}

TEST(GradientDescent, UpdatesHiddenLayersByOrthogonalisedMomentumAndTheLastByAdam)
{
  inr::Description description = SmallDescription();
  description.network.neurons = 24;
  description.network.hiddenLayers = 3;
  const inr::Layout layout(description);
  const std::vector<StepTaken> steps = TakeSteps(description, 120);
  for (int layer = 0; layer < 3; ++layer) {
    ExpectOrthogonalised(steps, layout.layers[static_cast<std::size_t>(layer)]);
  }
  ExpectAdam(steps, layout.layers[3].offset, layout.gridOffset - layout.layers[3].offset);
}

TEST(GradientDescent, UpdatesAWideNetworkAsAdamDoes)
{
  inr::Description description = SmallDescription();
  description.network.hiddenLayers = 1;
  description.network.neurons = 128;
  ExpectOrthogonalised(TakeSteps(description, 2), inr::Layout(description).layers[0]);
  description.network.neurons = 129;
  ExpectAdam(TakeSteps(description, 40), 0, 200);
}

TEST(LearningRate, IsConstantThenFallsInALine)
{
  const inr::LearningRate rate;
  EXPECT_EQ(rate.at(0, 1000), rate.initial);
  EXPECT_EQ(rate.at(100, 1000), rate.initial);
  EXPECT_LT(rate.at(110, 1000), rate.initial);
  EXPECT_NEAR(rate.at(550, 1000), 0.5f * rate.initial, 1e-6f);
  EXPECT_EQ(rate.at(1000, 1000), rate.last);
  EXPECT_EQ(rate.at(1u << 30, 1000), rate.last);
  for (const std::uint64_t planned : {0, 1, 9}) {
    EXPECT_EQ(rate.at(0, planned), rate.initial);
    EXPECT_EQ(rate.at(10, planned), rate.last);
  }
}

} // namespace test::gradients
