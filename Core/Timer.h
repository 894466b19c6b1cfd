// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace inr {

/// Seconds since some moment, by a clock that never goes back.
inline double SteadySeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Wall time since it was made, in seconds, and how much of a limit is left.
class Timer
{
public:
  explicit Timer(double limit = 0) : Limit(limit) {}
  double seconds() const { return SteadySeconds() - this->Start; }
  double left() const { return this->Limit - this->seconds(); }

private:
  double Start = SteadySeconds();
  double Limit;
};

} // namespace inr
