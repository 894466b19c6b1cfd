// SPDX-License-Identifier: BSD-3-Clause
//
// The kernels at points against float64 and against Core, on the host and on the GPU.
#include "Core/Error.h"
#include "Testing/CUDA/Places.h"
#include "Testing/Core/Inference/LongDoubleTruth.h"
#include "Testing/Core/Inference/TruthCase.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <utility>

namespace test::conformance {

class Conformance : public InEveryPlace
{
protected:
  static std::vector<float> values(const inr::ModelPointer& model,
                                   const std::vector<glm::vec3>& positions, HostLaunch launch = {})
  {
    std::vector<float> values(positions.size(), 1e30f); // unwritten
    evaluator(model, launch)
        ->evaluate(positions.data(), static_cast<std::int64_t>(values.size()), values.data());
    return values;
  }

  static std::vector<float> valuesOfCore(const inr::ModelPointer& model,
                                         const std::vector<glm::vec3>& positions)
  {
    std::vector<float> values(positions.size());
    inr::MakeEvaluator(model)->evaluate(positions.data(), static_cast<std::int64_t>(values.size()),
                                        values.data());
    return values;
  }
};

/// A model whose parameters half precision holds exactly, so that only arithmetic is compared.
inr::ModelPointer Rounded(inr::Model model)
{
  for (float& parameter : model.parameters) {
    parameter = inr::cuda::ToFloat(inr::cuda::ToHalf(parameter));
  }
  return std::make_shared<const inr::Model>(std::move(model));
}

std::vector<double> Truth(const inr::ModelPointer& model, const std::vector<glm::vec3>& positions)
{
  const LongDoubleTruth truth(*model);
  std::vector<double> values;
  for (const glm::vec3& position : positions) {
    values.push_back(static_cast<double>(truth(position).value));
  }
  return values;
}

/// Half precision keeps each layer's results to 2^-11; in random networks, where terms cancel, that
/// may add up to several times as much.
TEST_P(Conformance, EveryKindOfModelAgreesWithLongDouble)
{
  EXPECT_GE(CaseNames().size(), 20u);
  for (const std::string& name : CaseNames()) {
    const TruthCase truth(name);
    const inr::ModelPointer model = Rounded(truth.Source);
    const std::vector<float> results = values(model, truth.Positions);
    EXPECT_LT(RelativeError(results, Truth(model, truth.Positions)),
              GetParam().half() ? 5e-3 : 1e-5)
        << name;
    EXPECT_LT(RelativeError(results, valuesOfCore(model, truth.Positions)),
              GetParam().half() ? 5e-3 : 1e-5)
        << name;
  }
}

/// And a trained one, whose parameters are halves and whose terms cancel less, to 1e-3.
TEST_P(Conformance, ATrainedModelAgreesWithCore)
{
  const Field<float> field = WaveField();
  inr::TrainingOptions options = Steps(200);
  options.storedAs = inr::ParameterType::Half;
  const inr::ModelPointer model = inr::TrainModel(field.data(), {}, options);
  ASSERT_EQ(model->storedAs, inr::ParameterType::Half);
  ASSERT_GT(model->quality->psnr, 25);
  const std::vector<glm::vec3> positions = RandomPositions(5000);
  EXPECT_LT(RelativeError(values(model, positions), valuesOfCore(model, positions)),
            GetParam().half() ? 1e-3 : 1e-5);
}

/// The tensor cores' sums are not rounded where the host's are; apart from that it is the same.
TEST_P(Conformance, EveryKindOfModelAgreesWithTheLaunchOnTheHost)
{
  for (const std::string& name : CaseNames()) {
    const TruthCase truth(name);
    const auto model = std::make_shared<const inr::Model>(truth.Source);
    std::vector<float> expected(truth.Positions.size());
    EmulatedModel(model, GetParam().precision, {})
        .inferPoints(&truth.Positions[0].x, static_cast<std::int64_t>(expected.size()),
                     expected.data());
    EXPECT_LT(RelativeError(values(model, truth.Positions), expected),
              GetParam().half() ? 1e-3 : 1e-5)
        << name;
  }
}

TEST_P(Conformance, EveryWidthAgreesWithCore)
{
  for (const int neurons : {1, 16, 17, 32, 48, 64, 100, 128, 200}) {
    if (GetParam().half() && neurons > inr::cuda::MostFusedNeurons) {
      continue;
    }
    inr::Description description = SmallDescription();
    description.network.neurons = neurons;
    description.network.activation = inr::Activation::LeakyReLU;
    const inr::ModelPointer model = Rounded(*RandomModel(description));
    const std::vector<glm::vec3> positions = RandomPositions(1000);
    EXPECT_LT(RelativeError(values(model, positions), valuesOfCore(model, positions)),
              GetParam().half() ? 5e-3 : 1e-5)
        << neurons;
  }
}

TEST_P(Conformance, ValueDoesNotDependOnTheBatch)
{
  const auto model = RandomModel(SmallDescription());
  const std::vector<glm::vec3> positions = RandomPositions(333);
  const std::vector<float> together = values(model, positions);
  for (const std::size_t count : {1u, 31u, 33u, 128u, 129u}) {
    const std::vector<glm::vec3> first(positions.begin(),
                                       positions.begin() + static_cast<std::ptrdiff_t>(count));
    const std::vector<float> apart = values(model, first);
    EXPECT_TRUE(std::equal(apart.begin(), apart.end(), together.begin())) << count;
  }
  EXPECT_TRUE(values(model, {}).empty());
}

/// More than what is copied at once, and no whole number of that.
TEST_P(Conformance, LongBatchesAreWhole)
{
  inr::Description description = SmallDescription();
  description.network.neurons = 16;
  description.network.hiddenLayers = 1;
  const auto model = RandomModel(description);
  const std::vector<glm::vec3> once = RandomPositions(1000);
  const std::size_t copies = GetParam().place == Place::Gpu ? 400 : 3;
  std::vector<glm::vec3> positions;
  for (std::size_t k = 0; k < copies; ++k) {
    positions.insert(positions.end(), once.begin(), once.end());
  }
  const std::vector<float> expected = values(model, once);
  const std::vector<float> results = values(model, positions);
  for (std::size_t k = 0; k < results.size(); ++k) {
    ASSERT_EQ(results[k], expected[k % once.size()]) << k;
  }
}

TEST_P(Conformance, PositionsAreClampedAndNaNIsZero)
{
  const auto model = RandomModel(SmallDescription());
  const std::vector<glm::vec3> bad = {{NAN, 0.5f, 1e30f}, {-1e30f, -INFINITY, INFINITY}};
  const std::vector<glm::vec3> good = {{0, 0.5f, 1}, {0, 0, 1}};
  EXPECT_EQ(values(model, bad), values(model, good));
}

/// More features than a block's shared memory holds rows of: a thread takes each sample by itself.
TEST_P(Conformance, AnyNumberOfLevelsAgreesWithCore)
{
  if (GetParam().half()) {
    GTEST_SKIP() << "refused, see HalfPrecision";
  }
  inr::Description description = SmallDescription();
  description.grid.levels = 64;
  description.grid.features = 8;
  description.grid.perLevelScale = 1.1f;
  const auto model = RandomModel(description);
  const std::vector<glm::vec3> positions = RandomPositions(300);
  EXPECT_LT(RelativeError(values(model, positions), valuesOfCore(model, positions)), 1e-5);
}

/// Whatever the order of threads and blocks, with room for the weights or without.
TEST_P(Conformance, OrderAndRoomChangeNoBit)
{
  if (GetParam().place == Place::Gpu) {
    GTEST_SKIP() << "the order of threads is the GPU's own";
  }
  for (const int neurons : {16, 64, 128}) {
    inr::Description description = SmallDescription();
    description.network.neurons = neurons;
    const auto model = RandomModel(description);
    const std::vector<glm::vec3> positions = RandomPositions(1000);
    const std::vector<float> expected = values(model, positions, {3, false, 227 << 10});
    EXPECT_EQ(values(model, positions, {2, true, 1 << 10}), expected) << neurons;
    EXPECT_EQ(values(model, positions, {1, true, 227 << 10}), expected) << neurons;
  }
}

/// What overflows on its way is what Core gives, and nothing else is.
TEST_P(Conformance, CoreComputesWhatOverflows)
{
  const float scale = GetParam().half() ? 300.0f : 1e15f;
  auto model = RandomModel(SmallDescription());
  for (float& parameter : model->parameters) {
    parameter *= scale;
  }
  const inr::ModelPointer rounded = GetParam().half() ? Rounded(*model) : inr::ModelPointer(model);
  const std::vector<glm::vec3> positions = RandomPositions(500);
  std::vector<float> marked(positions.size());
  EmulatedModel(rounded, GetParam().precision, {})
      .inferPoints(&positions[0].x, static_cast<std::int64_t>(positions.size()), marked.data());
  EXPECT_TRUE(std::any_of(marked.begin(), marked.end(), [](float v) { return std::isnan(v); }));
  const std::vector<float> results = values(rounded, positions, Overflowing());
  const std::vector<float> expected = valuesOfCore(rounded, positions);
  EXPECT_LT(RelativeError(results, expected), GetParam().half() ? 5e-3 : 1e-5);
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (std::isnan(marked[k])) {
      ASSERT_EQ(results[k], expected[k]) << k;
    }
  }
}

/// A sum that leaves float's range on its way and would come back, as -infinity that ReLU cuts off.
TEST_P(Conformance, NoOverflowHidesBehindAnActivation)
{
  if (GetParam().half()) {
    GTEST_SKIP() << "halves do not hold such parameters";
  }
  inr::Description description = SmallDescription();
  description.network.hiddenLayers = 1;
  auto model = RandomModel(description);
  const inr::Layout layout(description);
  std::fill(model->parameters.begin(), model->parameters.end(), 0.0f);
  std::fill(model->parameters.begin() + static_cast<std::ptrdiff_t>(layout.gridOffset),
            model->parameters.end(), 1e19f);
  const float weights[4] = {-2e19f, -2e19f, 3e19f, 3e19f};
  std::copy(std::begin(weights), std::end(weights), model->parameters.begin());
  model->parameters[layout.layers[1].offset] = 1e-30f;
  // On the host, a tile's sums are longer than floats.
  const bool leaves = GetParam().precision == inr::cuda::Precision::Plain;
  for (const float value :
       values(model, RandomPositions(50), leaves ? Overflowing() : HostLaunch{})) {
    EXPECT_NEAR(value, 2e8f, 1e4f);
  }
}

TEST_P(Conformance, ModelsThatContradictThemselvesAreRefused)
{
  auto model = RandomModel(SmallDescription());
  model->parameters[77] = INFINITY;
  EXPECT_THROW(evaluator(model), inr::Error);
  model->parameters.pop_back();
  EXPECT_THROW(evaluator(model), inr::Error);
}

INSTANTIATE_TEST_SUITE_P(Kernels, Conformance, testing::ValuesIn(AllSettings()), NameOf);

} // namespace test::conformance
