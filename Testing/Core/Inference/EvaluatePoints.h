// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"

#include <cstdint>
#include <vector>

inline std::vector<float> Evaluate(const inr::Evaluator& evaluator,
                                   const std::vector<glm::vec3>& positions)
{
  std::vector<float> values(positions.size());
  evaluator.evaluate(positions.data(), static_cast<std::int64_t>(positions.size()), values.data());
  return values;
}
