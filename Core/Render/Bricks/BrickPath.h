// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

/// A ray's way through one brick: local coordinate = clamp(origin + along * direction, 0, last),
/// voxel i at i; `along` counts steps.
struct BrickPath
{
  const void* voxels; ///< x fastest
  float base;         ///< value = base + quantum * stored
  float quantum;
  float origin[3];
  float direction[3];
  float last[3];
};

} // namespace inr
