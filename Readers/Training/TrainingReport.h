// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <chrono>
#include <string>

/// What training with other processes took, to go behind its time; nothing where there were none.
std::string TimesOfGroup(const inr::TrainingRecord& training);

/// Puts a training's progress into words: what is done, how fast, and how long it will take.
class TrainingReport
{
public:
  using Clock = std::chrono::steady_clock;

  explicit TrainingReport(Clock::time_point now = Clock::now()) : Start(now) {}

  /// As "Training INR, 1.31 M samples/s, 80 s left" or "Training INR on the GPU, from device
  /// memory, ..."; what is not known yet is left out.
  std::string text(const inr::TrainingProgress& progress, Clock::time_point now = Clock::now());

private:
  Clock::time_point Start;     ///< from where the rest is reckoned
  double FirstFraction = 0;    ///< then
  Clock::time_point FirstStep; ///< of the training
  std::uint64_t FirstSteps = 0;
};
