// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/TrainingReport.h"

#include <gtest/gtest.h>

#include <chrono>

namespace {

using inr::TrainingPhase;

/// A report whose clock says what the test says.
class Told
{
public:
  /// Seconds since the report was made.
  std::string at(double seconds, const inr::TrainingProgress& progress)
  {
    using Clock = TrainingReport::Clock;
    const auto passed = std::chrono::duration<double>(seconds);
    return this->Report.text(progress,
                             this->Begin + std::chrono::duration_cast<Clock::duration>(passed));
  }

private:
  TrainingReport::Clock::time_point Begin;
  TrainingReport Report{Begin};
};

} // namespace

TEST(TrainingReport, SaysHowFastAndHowLongOnceThatIsKnown)
{
  Told told;
  EXPECT_EQ(told.at(1, {TrainingPhase::Reading, 0.01, 0}), "Reading the volume");
  EXPECT_EQ(told.at(2, {TrainingPhase::Reading, 0.05, 0}), "Reading the volume, 38 s left");
  EXPECT_EQ(told.at(4, {TrainingPhase::Training, 0.1, 1}), "Training INR");
  // 100 steps of 16,384 samples in 5 s; 0.02 of all is too little to go by.
  EXPECT_EQ(told.at(9, {TrainingPhase::Training, 0.12, 101}), "Training INR, 0.328 M samples/s");
  EXPECT_EQ(told.at(16, {TrainingPhase::Training, 0.2, 301}),
            "Training INR, 0.41 M samples/s, 96 s left");
  EXPECT_EQ(told.at(44, {TrainingPhase::Training, 0.3, 401}),
            "Training INR, 0.164 M samples/s, 2 min left");
  EXPECT_EQ(told.at(94, {TrainingPhase::Measuring, 0.95, 401}), "Measuring INR quality, 5 s left");
}

// What was done before is done in no time.
TEST(TrainingReport, ReckonsWithWhatATrainingDoesThatGoesOn)
{
  Told told;
  EXPECT_EQ(told.at(1, {TrainingPhase::Reading, 0.05, 0}), "Reading the volume, 19 s left");
  EXPECT_EQ(told.at(5, {TrainingPhase::Training, 0.85, 5000}), "Training INR");
  EXPECT_EQ(told.at(6, {TrainingPhase::Training, 0.86, 5100}), "Training INR, 1.64 M samples/s");
  EXPECT_EQ(told.at(10, {TrainingPhase::Training, 0.875, 5250}),
            "Training INR, 0.819 M samples/s, 25 s left");
}

TEST(TrainingReport, SaysWhatTrainsBesideTheCpu)
{
  Told told;
  inr::TrainingProgress progress{TrainingPhase::Training, 0.01, 1};
  progress.accelerated = true;
  progress.pipeline = inr::TrainingPipeline::Storage;
  EXPECT_EQ(told.at(1, progress), "Training INR on the GPU, from storage");
  progress.steps = 101;
  progress.pipeline = inr::TrainingPipeline::HostMemory;
  EXPECT_EQ(told.at(6, progress), "Training INR on the GPU, from host memory, 0.328 M samples/s");
}

TEST(TrainingReport, SaysWhatAGroupTookWhereThereWasOne)
{
  inr::TrainingRecord training;
  training.waitingSeconds = 1.25;
  EXPECT_EQ(TimesOfGroup(training), "");
  training.exchangeSeconds = 2.5;
  EXPECT_EQ(TimesOfGroup(training), ", 2.5 s of them to exchange gradients and 1.25 s to wait for "
                                    "those of other processes");
}
