// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Hierarchy.h"
#include "Core/Inference/Evaluator.h"

#include <memory>

namespace inr {

/// Where the voxels of bricks come from. Immutable: any number of threads may use one at once.
class BrickSource
{
public:
  virtual ~BrickSource() = default;

  /// Normalised values in [0, 1], Hierarchy::voxelsPerBrick() for each of `count` bricks. Voxels
  /// beyond the level's last one repeat it.
  virtual void infer(const BrickKey* keys, std::int64_t count, float* values,
                     const Arena& arena) const = 0;
};

/// Bricks of any field over the unit cube: level 0 holds its values at the voxels, a coarser level
/// the mean over 2 x 2 x 2 points of each voxel (a box filter).
std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const Evaluator> field,
                                                   const Hierarchy& hierarchy);

} // namespace inr
