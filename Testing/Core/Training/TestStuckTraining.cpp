// SPDX-License-Identifier: BSD-3-Clause
//
// Networks all of whose neurons are off, from which no gradient leads away.
#include "Core/Training/Descent/GradientDescent.h"
#include "Core/Training/Quality/PsnrEstimate.h"
#include "Core/Training/TrainingLoop.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace test::stuck_training {

/// Begins with zeros, and stays there for so many times that it is to begin anew.
class Stuck : public inr::GradientDescent
{
public:
  Stuck(const inr::Arena& arena, std::size_t times)
      : GradientDescent(SmallDescription(), 1, inr::ChooseInstructionSet(""), arena), Times(times)
  {
    std::fill(this->parameters().begin(), this->parameters().end(), 0.0f);
  }
  void startAnew(std::uint64_t seed) override
  {
    this->Seeds.push_back(seed);
    this->At.push_back(this->steps());
    if (this->Seeds.size() > this->Times) {
      this->GradientDescent::startAnew(seed);
    }
  }

  std::vector<std::uint64_t> Seeds;
  std::vector<std::uint64_t> At;

private:
  std::size_t Times;
};

class StuckTraining : public testing::Test
{
protected:
  double psnr(inr::Descent& descent) const
  {
    return this->Estimate.measure(descent.view(), this->Kernel, inr::StopCheck());
  }
  /// Whether the training of so many steps began anew.
  bool train(Stuck& descent, std::uint64_t steps)
  {
    inr::TrainingOptions options = Steps(steps);
    options.seed = 1;
    const inr::TrainingGroup alone;
    inr::CheckpointKeeper keeper(inr::CheckpointOptions(), {});
    inr::StratifiedBatches batches(this->Source);
    inr::TrainingLoop loop(options, {}, keeper, alone, batches.pipeline());
    loop.run(descent, batches, this->Estimate, this->Kernel);
    return loop.beganAnew();
  }

  Field<float> Data = WaveField();
  inr::Arena Threads{2};
  inr::InMemorySource Source{this->Data.data(), -1, 1};
  inr::PsnrEstimate Estimate{this->Source, 1, this->Threads, 2000};
  const inr::EvaluateKernel& Kernel = inr::EvaluateKernelFor(inr::ChooseInstructionSet(""));
};

TEST_F(StuckTraining, BeginsAnewFromAnotherSeed)
{
  Stuck descent(this->Threads, 0);
  const double before = this->psnr(descent);
  EXPECT_TRUE(this->train(descent, 300));
  EXPECT_EQ(descent.Seeds, std::vector<std::uint64_t>{2});
  EXPECT_EQ(descent.At, std::vector<std::uint64_t>{50});
  EXPECT_EQ(descent.steps(), 300u);
  EXPECT_GT(this->psnr(descent), before + 10);
}

TEST_F(StuckTraining, IsHelpedThreeTimes)
{
  Stuck descent(this->Threads, 100);
  EXPECT_TRUE(this->train(descent, 700));
  EXPECT_EQ(descent.Seeds, (std::vector<std::uint64_t>{2, 3, 4}));
  EXPECT_EQ(descent.At, (std::vector<std::uint64_t>{50, 100, 200}));
}

TEST_F(StuckTraining, IsNotHelpedTooLate)
{
  for (const std::uint64_t steps : {50u, 55u}) {
    Stuck descent(this->Threads, 0);
    EXPECT_FALSE(this->train(descent, steps));
    EXPECT_TRUE(descent.Seeds.empty());
  }
}

/// As what differs from voxel to voxel is, and what is right.
TEST_F(StuckTraining, IsOfTheSameAnswerEverywhere)
{
  Stuck descent(this->Threads, 0);
  EXPECT_TRUE(this->Estimate.isStuck(descent.view(), this->Kernel, inr::StopCheck()));
  const inr::PsnrEstimate ofZeros(std::vector<glm::vec3>(100, glm::vec3(0.5f)),
                                  std::vector<float>(100, 0.0f), this->Threads);
  EXPECT_FALSE(ofZeros.isStuck(descent.view(), this->Kernel, inr::StopCheck()));
  descent.startAnew(7);
  EXPECT_FALSE(this->Estimate.isStuck(descent.view(), this->Kernel, inr::StopCheck()));
}

TEST_F(StuckTraining, BeginsAnewAsTheFirstTime)
{
  Stuck descent(this->Threads, 0);
  descent.startAnew(3);
  this->train(descent, 20);
  descent.startAnew(7);
  inr::GradientDescent fresh(SmallDescription(), 7, inr::ChooseInstructionSet(""), this->Threads);
  EXPECT_EQ(descent.parameters(), fresh.parameters());
  EXPECT_EQ(descent.steps(), 20u);
  const inr::StateArrays arrays = descent.state();
  for (std::size_t k = 1; k < arrays.size(); ++k) { // moments and updates
    const auto* bytes = static_cast<const char*>(arrays[k].data);
    EXPECT_TRUE(std::all_of(bytes, bytes + arrays[k].bytes, [](char byte) { return byte == 0; }));
  }
}

} // namespace test::stuck_training
