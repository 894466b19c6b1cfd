// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace inr {

/// Wall time since construction, in seconds, and what had passed before.
class TrainingClock
{
public:
  explicit TrainingClock(double before = 0) : Before(before) {}

  double seconds() const
  {
    return this->Before +
           std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  double Before;
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

} // namespace inr
