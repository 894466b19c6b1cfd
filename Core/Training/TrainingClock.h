// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace inr {

/// Seconds since some moment, by a clock that never goes back.
inline double SteadySeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Wall time since construction, in seconds, and what had passed before.
class TrainingClock
{
public:
  explicit TrainingClock(double before = 0) : Before(before) {}

  double seconds() const { return this->Before + SteadySeconds() - this->Start; }

private:
  double Before;
  double Start = SteadySeconds();
};

} // namespace inr
