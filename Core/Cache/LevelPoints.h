// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickKey.h"

#include <glm/gtc/type_precision.hpp>

#include <algorithm>
#include <cstdint>

namespace inr {

/// Points along each axis at which a field is asked for a voxel of a level of a volume of `dims`
/// voxels: 1, its centre, or 2, a quarter of a voxel from there, whose mean is its value (a box
/// filter). `resolution`: see Evaluator.
///
/// A voxel of level 0 is a point, and one that spans few cells of the field's finest lattice may
/// be: linear interpolation between voxels smooths what is in them once more, and is nearer to the
/// field when the voxels do not. Up to 2.5 cells that is so of every model that was looked at
/// (levels.json of Testing/Benchmarks); of more, points alone show what is between the voxels as
/// grain.
inline int PointsPerAxis(const glm::i64vec3& dims, int level, std::int64_t resolution)
{
  const glm::i64vec3 voxels = VoxelsAtLevel(dims, level);
  const std::int64_t fewest = std::min({voxels.x, voxels.y, voxels.z});
  return level == 0 || (resolution > 0 && 2 * resolution <= 5 * fewest) ? 1 : 2;
}

} // namespace inr
