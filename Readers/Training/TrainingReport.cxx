// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Training/TrainingReport.h"

#include "Core/NumberText.h"
#include "Core/Training/Samples/BatchSource.h"

#include <algorithm>

namespace {

/// Before that a guess is worth nothing.
constexpr double SmallestFraction = 0.02;

double Seconds(TrainingReport::Clock::duration time)
{
  return std::chrono::duration<double>(time).count();
}

const char* Name(inr::TrainingPhase phase)
{
  switch (phase) {
  case inr::TrainingPhase::Reading:
    return "Reading the volume";
  case inr::TrainingPhase::Training:
    return "Training INR";
  default:
    return "Measuring INR quality";
  }
}

} // namespace

std::string TimesOfGroup(const inr::TrainingRecord& training)
{
  if (training.exchangeSeconds == 0) {
    return "";
  }
  return ", " + inr::NumberText(training.exchangeSeconds, 3) +
         " s of them to exchange gradients and " + inr::NumberText(training.waitingSeconds, 3) +
         " s to wait for those of other processes";
}

std::string TrainingReport::text(const inr::TrainingProgress& progress, Clock::time_point now)
{
  std::string text = Name(progress.phase);
  const bool training = progress.phase == inr::TrainingPhase::Training;
  if (training && progress.accelerated) {
    text += std::string(" on the GPU, from ") + inr::TrainingPipelineName(progress.pipeline);
  }
  if (training && this->FirstSteps == 0) {
    this->FirstSteps = progress.steps;
    this->FirstStep = now;
    // One that goes on from a checkpoint has not done in this time what was done before.
    this->Start = this->FirstStep;
    this->FirstFraction = progress.fraction;
  }
  const std::uint64_t latest = std::max(progress.steps, this->FirstSteps); // some may be lost
  const auto steps = static_cast<double>(latest - this->FirstSteps);
  if (training && steps > 0) {
    const double rate = steps * inr::BatchSize / Seconds(now - this->FirstStep);
    text += ", " + inr::NumberText(rate / 1e6, 3) + " M samples/s";
  }
  const double done = progress.fraction - this->FirstFraction;
  if (done > SmallestFraction) {
    const double left = Seconds(now - this->Start) * (1.0 - progress.fraction) / done;
    const bool isLong = left >= 120;
    text +=
        ", " + inr::DecimalText(isLong ? left / 60 : left, 0) + (isLong ? " min left" : " s left");
  }
  return text;
}
