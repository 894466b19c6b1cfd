// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Two planes across each axis cut the volume into 27 regions, some of which are shown; as
/// vtkVolumeMapper's cropping regions.
struct Cropping
{
  glm::dvec3 low{0.0}; ///< point indices of the planes
  glm::dvec3 high{0.0};
  /// Bit x + 3 y + 9 z is set where region (x, y, z) is shown: 0 is below the lower plane, 1
  /// between the two, 2 above the upper one.
  std::uint32_t flags = 1u << 13;

  INR_HOST_DEVICE bool showsRegion(const glm::ivec3& region) const
  {
    return (this->flags >> (region.x + 3 * region.y + 9 * region.z) & 1u) != 0;
  }
  /// Whether a point, by its indices, is shown.
  INR_HOST_DEVICE bool shows(const glm::dvec3& index) const
  {
    glm::ivec3 region;
    for (int axis = 0; axis < 3; ++axis) {
      region[axis] = index[axis] < this->low[axis] ? 0 : (index[axis] <= this->high[axis] ? 1 : 2);
    }
    return this->showsRegion(region);
  }

  bool operator==(const Cropping& other) const
  {
    return this->low == other.low && this->high == other.high && this->flags == other.flags;
  }
};

/// The smallest box of whole regions that holds all that is shown.
struct CroppedBox
{
  glm::dvec3 low;  ///< point indices, infinite where nothing is cut off
  glm::dvec3 high; ///< below `low` where nothing is shown
  bool full;       ///< and nothing else
};
CroppedBox BoxOf(const Cropping& cropping);

} // namespace inr
