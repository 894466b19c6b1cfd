// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Quantised.h"

#include <algorithm>
#include <cmath>

namespace inr {

std::vector<ParameterGroup> ParameterGroups(const Description& description)
{
  const Layout layout(description);
  const auto features = static_cast<std::uint64_t>(description.grid.features);
  std::vector<ParameterGroup> groups;
  for (const LayerShape& layer : layout.layers) {
    groups.push_back({layer.offset, static_cast<std::uint64_t>(layer.rows) *
                                        static_cast<std::uint64_t>(layer.columns)});
  }
  for (const GridLevel& level : layout.levels) {
    groups.push_back({layout.gridOffset + level.offset * features, level.entries * features});
  }
  return groups;
}

float FinestStep(float magnitude)
{
  // A hair more, so that rounding the quotient cannot lead beyond the largest multiple.
  const float step = magnitude / (LargestMultiple - 1.0f);
  return std::clamp(step, SmallestStep, LargestStep);
}

double NearestMultiple(float value, float step)
{
  return std::round(static_cast<double>(value) / static_cast<double>(step));
}

void RoundToStep(float* parameters, std::uint64_t count, float step)
{
  std::transform(parameters, parameters + count, parameters, [&](float value) {
    return ValueOfMultiple(static_cast<std::int16_t>(NearestMultiple(value, step)), step);
  });
}

} // namespace inr
