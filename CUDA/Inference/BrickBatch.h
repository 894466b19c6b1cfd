// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Inference/Kernels/BrickGeometry.h"
#include "Core/Cache/Hierarchy.h"

#include <cstdint>
#include <vector>

namespace inr {
namespace cuda {

/// What one launch infers: bricks, or layers of them.
struct BrickBatch
{
  std::vector<BrickJob> jobs;
  std::int64_t items = 0; ///< see BrickItem
  std::int64_t values = 0;

  /// `layers` layers of a brick, from the `z`-th of its brickDims().z on, behind what is there.
  void append(const Hierarchy& levels, BrickKey key, std::int64_t z, std::int64_t layers);
};

} // namespace cuda
} // namespace inr
