// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace inr {

/// Wall time since it was made, and how much of a limit is left.
class Timer
{
public:
  explicit Timer(double limit = 0) : Limit(limit) {}
  double seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }
  double left() const { return this->Limit - this->seconds(); }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
  double Limit;
};

} // namespace inr
