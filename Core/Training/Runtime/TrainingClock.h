// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Timer.h"

namespace inr {

/// Wall time since construction, in seconds, and what had passed before: until the checkpoint that
/// a training goes on from, or in the survey of its data.
class TrainingClock
{
public:
  explicit TrainingClock(double before = 0) : Before(before) {}

  double seconds() const { return this->Before + this->SinceThen.seconds(); }

private:
  double Before;
  Timer SinceThen;
};

} // namespace inr
