// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <cstdint>

namespace inr {

/// Share of the time limit after which it is known how many steps it allows: less than that in
/// which the learning rate is constant.
constexpr double TimingShare = 0.03;

struct TimedSteps
{
  std::uint64_t steps = 0;
  double seconds = 0;
};

/// Steps to spread the learning rate over, as far as it is known before the first one; 0 = the rate
/// is constant until the clock shows it.
std::uint64_t StepsAhead(const TrainingOptions& options);

/// Whether the time limit has a say in the plan.
bool ClockPlans(const TrainingOptions& options);

/// The plan when the time limit has its say, `now`; between `since` and now steps took as long as
/// those to come. That known ahead stays, so that the result can be repeated, unless the time
/// allows clearly fewer steps.
std::uint64_t StepsByTheClock(const TrainingOptions& options, const TimedSteps& since,
                              const TimedSteps& now);

} // namespace inr
