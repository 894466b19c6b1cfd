// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
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
  /// What is left, but at least a quarter of the limit: however long rendering itself takes, a
  /// fifth of all the time is for what it waits for.
  double leftForLoading() const { return std::max(this->left(), 0.25 * this->Limit); }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
  double Limit;
};

} // namespace inr
