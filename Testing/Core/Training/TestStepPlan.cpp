// SPDX-License-Identifier: BSD-3-Clause
//
// How many steps the learning rate is spread over.
#include "Core/Training/Runtime/LearningRate.h"
#include "Core/Training/StepPlan.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

namespace test::step_plan {

constexpr std::uint64_t ToTarget = 10000;

inr::TrainingOptions Options(std::uint64_t maximumSteps, double timeLimit, double targetPsnr = 0)
{
  inr::TrainingOptions options = Steps(maximumSteps);
  options.timeLimit = timeLimit;
  options.targetPsnr = targetPsnr;
  return options;
}

TEST(StepPlan, IsKnownAheadUnlessTheClockAloneIsTheEnd)
{
  EXPECT_EQ(inr::StepsAhead(Options(0, 60)), 0u);
  EXPECT_EQ(inr::StepsAhead(Options(500, 60)), 500u);
  EXPECT_EQ(inr::StepsAhead(Options(0, 60, 40)), ToTarget);
  EXPECT_EQ(inr::StepsAhead(Options(0, 0, 40)), ToTarget);
  inr::TrainingOptions repeated = Options(500, 60, 40);
  repeated.plannedSteps = 700;
  EXPECT_EQ(inr::StepsAhead(repeated), 700u);
  EXPECT_FALSE(inr::ClockPlans(repeated));
}

TEST(StepPlan, IsWhatTheTimeAllows)
{
  EXPECT_EQ(inr::StepsByTheClock(Options(0, 100), {0, 0}, {60, 3}), 2000u);
  // Ten steps and two seconds were before it was an accelerator's.
  EXPECT_EQ(inr::StepsByTheClock(Options(0, 102), {10, 2}, {70, 5}), 2010u);
}

TEST(StepPlan, IsTheSmallerOfMaximumStepsAndWhatTheTimeAllows)
{
  const inr::TimedSteps now{60, 3}; // 2,000 steps in all
  EXPECT_EQ(inr::StepsByTheClock(Options(20000, 100), {}, now), 2000u);
  EXPECT_EQ(inr::StepsByTheClock(Options(1000, 100), {}, now), 1000u);
  // Too near to tell them apart: the result of MaximumSteps can be repeated.
  EXPECT_EQ(inr::StepsByTheClock(Options(2200, 100), {}, now), 2200u);
}

TEST(StepPlan, IsLongEnoughForATargetAndNoLonger)
{
  const inr::TimedSteps now{6000, 90}; // of an hour
  EXPECT_EQ(inr::StepsByTheClock(Options(0, 3600, 40), {}, now), ToTarget);
  EXPECT_EQ(inr::StepsByTheClock(Options(0, 100, 40), {}, {60, 3}), 2000u);
}

// What was done at a constant rate stays as it was.
TEST(StepPlan, ChangesNoRateOfTheStepsBefore)
{
  const inr::LearningRate rate;
  for (const std::uint64_t maximum : {0u, 700u, 5000u}) {
    const inr::TimedSteps now{400, 50}; // a step took so long that it is more than 3 %
    const inr::TrainingOptions options = Options(maximum, 100);
    const std::uint64_t plan = inr::StepsByTheClock(options, {}, now);
    const std::uint64_t ahead = inr::StepsAhead(options);
    EXPECT_EQ(rate.at(now.steps, plan), ahead > 0 ? rate.at(now.steps, ahead) : rate.initial);
  }
}

// A limit that is never reached changes nothing.
TEST(StepPlan, OfATargetDoesNotDependOnATimeLimitThatIsASafetyNet)
{
  inr::TrainingOptions options = Options(0, 0, 20);
  options.description = SmallDescription();
  options.storedAs = inr::ParameterType::Half;
  const Field<float> field = WaveField();
  const inr::ModelPointer without = inr::TrainModel(field.data(), {}, options);
  options.timeLimit = 1e9;
  const inr::ModelPointer with = inr::TrainModel(field.data(), {}, options);
  EXPECT_EQ(with->training->plannedSteps, ToTarget);
  EXPECT_EQ(with->training->steps, without->training->steps);
  EXPECT_EQ(with->parameters, without->parameters);
}

TEST(StepPlan, IsMadeByTheClockWhereStepsAreLimitedToo)
{
  inr::TrainingOptions options = Options(1000000000, 0.5);
  options.description = SmallDescription();
  options.storedAs = inr::ParameterType::Half;
  const inr::ModelPointer model = inr::TrainModel(WaveField().data(), {}, options);
  EXPECT_LT(model->training->plannedSteps, 750000000u);
}

} // namespace test::step_plan
