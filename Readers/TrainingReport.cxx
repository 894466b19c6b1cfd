// SPDX-License-Identifier: BSD-3-Clause
#include "TrainingReport.h"

#include "Core/Training/BatchSource.h"

#include <cstdio>

namespace {

/// Before that a guess is worth nothing.
constexpr double SmallestFraction = 0.02;

double SecondsSince(std::chrono::steady_clock::time_point start)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string Formatted(const char* format, double number)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, number);
  return text;
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

std::string TrainingReport::text(const inr::TrainingProgress& progress)
{
  std::string text = Name(progress.phase);
  const bool training = progress.phase == inr::TrainingPhase::Training;
  if (training && this->FirstSteps == 0) {
    this->FirstSteps = progress.steps;
    this->FirstStep = Clock::now();
    // One that goes on from a checkpoint has not done in this time what was done before.
    this->Start = this->FirstStep;
    this->FirstFraction = progress.fraction;
  }
  const auto steps = static_cast<double>(progress.steps - this->FirstSteps);
  if (training && steps > 0) {
    const double rate = steps * inr::BatchSize / SecondsSince(this->FirstStep);
    text += Formatted(", %.3g M samples/s", rate / 1e6);
  }
  const double done = progress.fraction - this->FirstFraction;
  if (done > SmallestFraction) {
    const double left = SecondsSince(this->Start) * (1.0 - progress.fraction) / done;
    text += left < 120 ? Formatted(", %.0f s left", left) : Formatted(", %.0f min left", left / 60);
  }
  return text;
}
