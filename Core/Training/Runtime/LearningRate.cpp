// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Runtime/LearningRate.h"

#include <algorithm>

namespace inr {

float LearningRate::at(std::uint64_t step, std::uint64_t plannedSteps) const
{
  const std::uint64_t constant = plannedSteps / ConstantShare;
  if (step <= constant) {
    return this->initial;
  }
  const double fallen = static_cast<double>(step - constant) /
                        static_cast<double>(std::max(plannedSteps - constant, std::uint64_t{1}));
  return std::max(this->last, static_cast<float>(this->initial * (1.0 - fallen)));
}

} // namespace inr
