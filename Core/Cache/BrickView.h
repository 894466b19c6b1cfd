// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

/// A brick's voxels as they are stored; value = low + step * stored, x fastest.
struct BrickView
{
  const void* voxels; ///< float, uint16 or uint8
  float low;
  float step;
};

} // namespace inr
