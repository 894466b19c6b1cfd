// SPDX-License-Identifier: BSD-3-Clause
//
// Training that starts from the parameters of a similar volume's model.
#include "Core/Inference/Evaluator.h"
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Samples/SampleSource.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::warm_start {

constexpr glm::i64vec3 Dims(40, 36, 32);

/// Waves that have moved along x.
Field<float> Moved(double voxels)
{
  Field<float> field{Dims, inr::ScalarType::Float32, {}};
  for (std::int64_t z = 0; z < Dims.z; ++z) {
    for (std::int64_t y = 0; y < Dims.y; ++y) {
      for (std::int64_t x = 0; x < Dims.x; ++x) {
        const double place = static_cast<double>(x) - voxels;
        field.values.push_back(
            static_cast<float>(std::sin(0.61 * place) * std::cos(0.43 * static_cast<double>(y)) *
                               std::cos(0.37 * static_cast<double>(z) + 0.1)));
      }
    }
  }
  return field;
}

inr::TrainingOptions StepsFrom(const inr::ModelPointer& start, std::uint64_t steps)
{
  inr::TrainingOptions options = Steps(steps);
  options.start = start;
  options.storedAs = inr::ParameterType::Float;
  return options;
}

class WarmStart : public testing::Test
{
protected:
  inr::ModelPointer train(double voxels, std::uint64_t steps, const inr::ModelPointer& start = {})
  {
    return inr::TrainModel(Moved(voxels).data(), {}, StepsFrom(start, steps));
  }
};

TEST_F(WarmStart, BeginsWithTheParametersAndErrorOfTheStart)
{
  const inr::ModelPointer start = this->train(0, 200);
  const Field<float> field = Moved(0);
  const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
  const inr::InMemorySource source(field.data(), *low, *high);
  const inr::Arena arena;
  inr::GradientDescent descent(start->description, 7, inr::ChooseInstructionSet(""), arena);
  descent.startFrom(start->parameters);
  EXPECT_EQ(descent.parameters(), start->parameters);
  inr::StratifiedBatches batches(source);
  const double error = descent.step(batches).value(); // before its update, on random positions
  EXPECT_NEAR(-10 * std::log10(error), start->quality->psnr, 1.0);
  EXPECT_NE(descent.parameters(), start->parameters);
}

TEST_F(WarmStart, GoesOnFromTheStart)
{
  const inr::ModelPointer start = this->train(0, 100);
  const inr::ModelPointer one = this->train(0.5, 1, start);
  const auto farthest = [&](std::size_t begin, std::size_t end) {
    double found = 0;
    for (std::size_t k = begin; k < end; ++k) {
      found = std::max<double>(found, std::abs(one->parameters[k] - start->parameters[k]));
    }
    return found;
  };
  const inr::Layout layout(start->description);
  const double ofWeights = farthest(0, layout.gridOffset);
  const double ofFeatures = farthest(layout.gridOffset, start->parameters.size());
  EXPECT_GT(ofWeights, 0);
  EXPECT_GT(ofFeatures, 0);
  // What Adam moves a feature by in its first step is the learning rate; a layer moves by what is
  // nearly orthogonal, with elements of 1.21 at most.
  EXPECT_LE(ofFeatures, 1.001 * inr::LearningRate().initial);
  EXPECT_LE(ofWeights, 1.21 * inr::OrthogonalRate(1) * inr::LearningRate().initial);
}

TEST_F(WarmStart, IsBetterAfterAsManySteps)
{
  const inr::ModelPointer start = this->train(0, 200);
  const double cold = this->train(0.5, 60)->quality->psnr;
  const double warm = this->train(0.5, 60, start)->quality->psnr;
  EXPECT_GT(warm, cold + 4) << cold;
}

TEST_F(WarmStart, IsOnRecord)
{
  const inr::ModelPointer first = this->train(0, 100);
  EXPECT_FALSE(first->training->earlierSteps.has_value());
  const inr::ModelPointer second = this->train(0.5, 27, first);
  EXPECT_EQ(second->training->steps, 27u);
  EXPECT_EQ(second->training->earlierSteps, 100u);
  EXPECT_EQ(this->train(1, 3, second)->training->earlierSteps, 127u);
}

TEST_F(WarmStart, LeavesOutParametersOfAnotherMeaning)
{
  const inr::ModelPointer start = this->train(0, 5);
  inr::TrainingOptions options = StepsFrom(nullptr, 5);
  options.description = start->description;
  options.description->grid.hash = inr::HashFunction::Prime; // as many, elsewhere
  const inr::ModelPointer cold = inr::TrainModel(Moved(0.5).data(), {}, options);
  options.start = start;
  const inr::ModelPointer tried = inr::TrainModel(Moved(0.5).data(), {}, options);
  EXPECT_EQ(tried->parameters, cold->parameters);
  EXPECT_FALSE(tried->training->earlierSteps.has_value());
}

/// As of a constant volume, or where all has moved by half a wave.
TEST_F(WarmStart, IsNotOfWhatSaysNothingOfTheData)
{
  Field<float> flat = Moved(0);
  std::fill(flat.values.begin(), flat.values.end(), 0.5f);
  const inr::ModelPointer cold = this->train(0, 5);
  for (const inr::ModelPointer& start :
       {inr::TrainModel(flat.data(), {}, StepsFrom(nullptr, 5)), this->train(5, 100)}) {
    ASSERT_EQ(start->description, cold->description);
    const inr::ModelPointer tried = this->train(0, 5, start);
    EXPECT_EQ(tried->parameters, cold->parameters);
    EXPECT_FALSE(tried->training->earlierSteps.has_value());
  }
}

TEST_F(WarmStart, IsTheSameOnAnyNumberOfThreads)
{
  const inr::ModelPointer start = this->train(0, 20);
  inr::TrainingOptions options = StepsFrom(start, 10);
  options.threads = 1;
  const inr::ModelPointer one = inr::TrainModel(Moved(0.5).data(), {}, options);
  options.threads = 3;
  EXPECT_EQ(one->parameters, inr::TrainModel(Moved(0.5).data(), {}, options)->parameters);
}

} // namespace test::warm_start
