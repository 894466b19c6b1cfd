// SPDX-License-Identifier: BSD-3-Clause
//
// What a user is told of a quality that was not reached.
#include "Core/Training/TargetReport.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

namespace test::target_report {

struct TargetReport : testing::Test
{
  /// Of a training to 40 dB.
  std::string report(double psnr, std::uint64_t steps, double seconds)
  {
    inr::Model model;
    model.quality = inr::Quality{psnr, 0.9, 0.1};
    model.training = inr::TrainingRecord();
    model.training->steps = steps;
    model.training->seconds = seconds;
    return inr::ShortOfTarget(model, this->Options);
  }

  void SetUp() override
  {
    this->Options.targetPsnr = 40;
    this->Options.maximumSteps = 1000;
    this->Options.timeLimit = 60;
  }

  inr::TrainingOptions Options;
};

TEST_F(TargetReport, HasNothingToSayOfWhatIsReached)
{
  for (const double psnr : {39.95, 41.0, HUGE_VAL}) {
    EXPECT_EQ(this->report(psnr, 200, 5), "");
  }
  this->Options.targetPsnr = 0;
  EXPECT_EQ(this->report(10, 1000, 5), "");
}

TEST_F(TargetReport, SaysHowMuchIsMissingAndWhy)
{
  const auto expect = [](const std::string& text, const std::string& words) {
    EXPECT_NE(text.find("37.50 dB, 2.50 dB below TargetPSNR"), std::string::npos) << text;
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  expect(this->report(37.5, 1000, 5), "MaximumSteps ended");
  expect(this->report(37.5, 400, 60.1), "TimeLimit ended");
  expect(this->report(37.5, 400, 5), "random voxels");
  this->Options.targetRatio = 50;
  expect(this->report(37.5, 400, 5), "TargetRatio");
}

TEST_F(TargetReport, IsOfTheModelAsItIsTrained)
{
  inr::TrainingOptions options = Steps(3);
  options.description = SmallDescription();
  options.targetPsnr = 90;
  const inr::ModelPointer model = inr::TrainModel(WaveField().data(), {}, options);
  EXPECT_NE(inr::ShortOfTarget(*model, options), "");
}

} // namespace test::target_report
