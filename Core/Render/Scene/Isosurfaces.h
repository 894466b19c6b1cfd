// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Model/MacroCells.h"
#include "Core/Render/Scene/ColorTable.h"

#include <glm/vec4.hpp>

#include <vector>

namespace inr {

/// A frame's isosurfaces; plain data.
struct SurfaceLookup
{
  const float* values = nullptr; ///< normalised, rising
  int count = 0;

  /// How many are not above `value`: a field that goes from one number to another passes those in
  /// between.
  INR_HOST_DEVICE int below(float value) const
  {
    int first = 0;
    int last = this->count;
    while (first < last) {
      const int middle = (first + last) / 2;
      if (this->values[middle] <= value) {
        first = middle + 1;
      } else {
        last = middle;
      }
    }
    return first;
  }

  /// Whether there is one of `range`.
  INR_HOST_DEVICE bool meets(const ValueRange& range) const
  {
    const int next = this->below(range.low);
    return (next > 0 && this->values[next - 1] == range.low) ||
           (next < this->count && this->values[next] <= range.high);
  }
};

/// Those of data values `values` that `volume` can take and `colors` do not leave transparent.
std::vector<float> VisibleSurfaces(const std::vector<double>& values, const VolumeInfo& volume,
                                   const ColorLookup& colors);

} // namespace inr
