// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <chrono>
#include <string>

/// Puts a training's progress into words: what is done, how fast, and how long it will take.
class TrainingReport
{
public:
  /// As "Training INR, 1.31 M samples/s, 80 s left"; what is not known yet is left out.
  std::string text(const inr::TrainingProgress& progress);

private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point Start = Clock::now(); ///< from where the rest is reckoned
  double FirstFraction = 0;               ///< then
  Clock::time_point FirstStep;            ///< of the training
  std::uint64_t FirstSteps = 0;
};
