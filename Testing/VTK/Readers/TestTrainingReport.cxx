// SPDX-License-Identifier: BSD-3-Clause
#include "TrainingReport.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace {

using inr::TrainingPhase;

/// Seconds that are left, by the words; -1 where they do not say.
double SecondsLeft(const std::string& text)
{
  const std::size_t end = text.find(" s left");
  return end == std::string::npos ? -1 : std::atof(&text[text.rfind(' ', end - 1)]);
}

} // namespace

TEST(TrainingReport, SaysHowLongItWillTakeOnceThatIsKnown)
{
  TrainingReport report;
  EXPECT_EQ(report.text({TrainingPhase::Reading, 0.01, 0}), "Reading the volume");
  EXPECT_EQ(report.text({TrainingPhase::Training, 0.01, 1}), "Training INR");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const std::string text = report.text({TrainingPhase::Training, 0.05, 200});
  EXPECT_NE(text.find("M samples/s"), std::string::npos) << text;
  EXPECT_GT(SecondsLeft(text), 0.3 * 0.95 / 0.05);
}

// What was done before is done in no time.
TEST(TrainingReport, ReckonsWithWhatATrainingDoesThatGoesOn)
{
  TrainingReport report;
  EXPECT_EQ(report.text({TrainingPhase::Training, 0.85, 5000}), "Training INR");
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(SecondsLeft(report.text({TrainingPhase::Training, 0.86, 5100})), -1);
  // 0.025 of it took 0.3 s or more, and 0.125 of it are left.
  EXPECT_GE(SecondsLeft(report.text({TrainingPhase::Training, 0.875, 5250})), 1);
}
