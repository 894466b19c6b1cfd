// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/vec3.hpp>

namespace inr {

/// A place at which a path asks for the field: native point index = voxel + fraction.
struct FieldPoint
{
  glm::ivec3 voxel;
  glm::vec3 fraction; ///< in [0, 1]
  int level;          ///< of the hierarchy, 0 = native
};

/// Moves `point`, where it stands: a whole one made elsewhere would be waited for. `index` is a
/// native point index, not negative and within 32 bits.
INR_HOST_DEVICE inline void MoveTo(FieldPoint& point, const glm::dvec3& index, int level)
{
  point.voxel = glm::ivec3(index); // not negative, so truncation is floor
  point.fraction = glm::vec3(index - glm::dvec3(point.voxel));
  point.level = level;
}

INR_HOST_DEVICE inline FieldPoint MakeFieldPoint(const glm::dvec3& index, int level = 0)
{
  FieldPoint point;
  MoveTo(point, index, level);
  return point;
}

/// Where a network is asked for it: in the unit cube. `dims`: voxels per axis.
INR_HOST_DEVICE inline glm::vec3 NetworkPosition(const FieldPoint& point, const glm::dvec3& dims)
{
  const glm::dvec3 index = glm::dvec3(point.voxel) + glm::dvec3(point.fraction);
  return glm::vec3((index + 0.5) / dims);
}

} // namespace inr
