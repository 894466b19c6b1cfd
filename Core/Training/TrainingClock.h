// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace inr {

/// Wall time since construction, in seconds.
class TrainingClock
{
public:
  double seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Start).count();
  }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
};

} // namespace inr
