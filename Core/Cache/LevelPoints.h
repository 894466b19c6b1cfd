// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickKey.h"

#include <glm/gtc/type_precision.hpp>

#include <cstdint>

namespace inr {

/// Points along each axis at which a field is asked for a voxel of a level of a volume of `dims`
/// voxels: 1, its centre, or 2, a quarter of a voxel from there, whose mean is its value (a box
/// filter). `resolution`: see Evaluator.
///
/// A voxel of level 0 is a point, and one in which a field tells few places apart may be: linear
/// interpolation between voxels smooths what is in them once more, and is nearer to the field when
/// the voxels do not. Of up to 2.5 places along each axis that is so of every model that was looked
/// at (levels.json of Testing/Benchmarks); of more, points alone show what is between them as
/// grain.
inline int PointsPerAxis(const glm::i64vec3& dims, int level, const glm::i64vec3& resolution)
{
  const glm::i64vec3 voxels = VoxelsAtLevel(dims, level);
  bool isFine = true;
  for (int axis = 0; axis < 3; ++axis) {
    isFine = isFine && resolution[axis] > 0 && 2 * resolution[axis] <= 5 * voxels[axis];
  }
  return level == 0 || isFine ? 1 : 2;
}

} // namespace inr
