// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// Learning rate over a training of planned length: constant at first, then falling in a straight
/// line to a low one, at which it stays. A function of step and plan alone, so that a run stopped
/// by the clock can be repeated.
struct LearningRate
{
  float initial = 1e-2f;
  float last = 1e-4f;
  static constexpr std::uint64_t ConstantShare = 10; ///< the first tenth of the planned steps

  float at(std::uint64_t step, std::uint64_t plannedSteps) const;
};

} // namespace inr
