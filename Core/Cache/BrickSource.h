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
  explicit BrickSource(const Hierarchy& hierarchy) : Levels(hierarchy) {}
  virtual ~BrickSource() = default;

  const Hierarchy& hierarchy() const { return this->Levels; }

  /// Points at which the field is asked for a brick's voxels.
  std::int64_t points(BrickKey key) const;

  /// One layer of a brick's voxels, the `z`-th of brickDims().z: normalised values in [0, 1], x
  /// fastest. Voxels beyond the level's last one repeat it.
  virtual void inferLayer(BrickKey key, std::int64_t z, float* values) const = 0;

  /// Bricks that are best inferred together, by one call of infer; 0: layers, on any number of
  /// threads at once. It may change at any time: a device may fail.
  virtual std::int64_t bricksAtOnce() const { return 0; }

  /// All layers of `count` bricks, one brick after the other.
  virtual void infer(const BrickKey* keys, std::int64_t count, float* values,
                     const Arena& arena) const;

  /// Layers of a brick that are in its level; all others are the last of them.
  std::int64_t layersInside(BrickKey key) const;
  /// Copies that one to all others. `values`: a whole brick.
  void repeatLastLayer(BrickKey key, float* values) const;

private:
  Hierarchy Levels;
};

/// Bricks of any field over the unit cube: level 0 holds its values at the voxels, a coarser level
/// the mean over 2 x 2 x 2 points of each voxel (a box filter).
std::shared_ptr<const BrickSource> MakeBrickSource(std::shared_ptr<const Evaluator> field,
                                                   const Hierarchy& hierarchy);

} // namespace inr
