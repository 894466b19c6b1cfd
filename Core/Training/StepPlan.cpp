// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/StepPlan.h"

#include "Core/Training/Runtime/LearningRate.h"

#include <algorithm>

namespace inr {

namespace {

/// A target ought to be reached as soon as may be: without a number of steps, the learning rate is
/// spread over so many, whatever the time limit would allow.
constexpr std::uint64_t StepsToTarget = 10000;

/// Share of the steps known ahead. What time allows is seen too inexactly, early in a training, to
/// tell more of them apart.
constexpr double ClearlyFewer = 0.75;

} // namespace

std::uint64_t StepsAhead(const TrainingOptions& options)
{
  if (options.plannedSteps > 0) {
    return options.plannedSteps;
  }
  if (options.maximumSteps > 0) {
    return options.maximumSteps;
  }
  return options.targetPsnr > 0 ? StepsToTarget : 0;
}

bool ClockPlans(const TrainingOptions& options)
{
  return options.plannedSteps == 0 && options.timeLimit > 0;
}

std::uint64_t StepsByTheClock(const TrainingOptions& options, const TimedSteps& since,
                              const TimedSteps& now)
{
  const double rate = static_cast<double>(now.steps - since.steps) / (now.seconds - since.seconds);
  const double left = options.timeLimit - since.seconds;
  // Not less than would have kept the rate constant up to here, so that it can be repeated.
  const std::uint64_t allowed = std::max(since.steps + static_cast<std::uint64_t>(rate * left),
                                         LearningRate::ConstantShare * now.steps);
  const std::uint64_t ahead = StepsAhead(options);
  const bool fewer = static_cast<double>(allowed) < ClearlyFewer * static_cast<double>(ahead);
  return ahead == 0 || fewer ? allowed : ahead;
}

} // namespace inr
