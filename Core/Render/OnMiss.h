// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

namespace inr {

/// What a ray does where the brick it wants is not there.
enum class OnMiss {
  UseCoarser, ///< read the nearest coarser level that is, and wish for the wanted one
  Approach,   ///< the same, but wish for the next level on the way from the coarser one
  Stop        ///< wait
};

/// Whether a level is on the way to finer ones. A voxel of level 1 is the mean of eight points, as
/// many as level 0 has voxels in its place: where those are wanted, they come as soon without it.
INR_HOST_DEVICE constexpr bool IsOnTheWay(int level) { return level != 1; }

} // namespace inr
