// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/Isosurfaces.h"

#include <algorithm>

namespace inr {

std::vector<float> VisibleSurfaces(const std::vector<double>& values, const VolumeInfo& volume,
                                   const ColorLookup& colors)
{
  std::vector<float> result;
  const double width = volume.high - volume.low;
  for (const double value : values) {
    const auto normalised = static_cast<float>((value - volume.low) / width);
    // Not what a constant volume would divide by 0 for, either.
    if (normalised >= 0.0f && normalised <= 1.0f && colors.at(normalised).w > 0.0f) {
      result.push_back(normalised);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

} // namespace inr
