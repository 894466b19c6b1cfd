// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BlockRows.h"
#include "Core/Cache/BrickPart.h"
#include "Core/Cache/Hierarchy.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Model/MacroCells.h"

#include <memory>

namespace inr {

/// Where the voxels of bricks come from. Immutable: any number of threads may use one at once.
class BrickSource
{
public:
  explicit BrickSource(const Hierarchy& hierarchy)
      : Levels(hierarchy), Lattice(hierarchy.brickDims())
  {}
  virtual ~BrickSource() = default;

  const Hierarchy& hierarchy() const { return this->Levels; }
  const BlockLattice& blocks() const { return this->Lattice; } ///< of each brick

  /// Between which values all of a brick's are, as far as that is known before they are; else
  /// empty.
  virtual ValueRange rangeOf(BrickKey key) const
  {
    (void)key;
    return {};
  }
  /// Points at which the field is asked for the voxels of a part.
  std::int64_t points(const BrickPart& part) const;

  /// One layer of a brick's voxels, the `z`-th of brickDims().z: normalised values in [0, 1], x
  /// fastest. Voxels beyond the level's last one repeat it.
  virtual void inferLayer(BrickKey key, std::int64_t z, float* values) const = 0;

  /// Whether parts of bricks can be had, too; else all parts have to be whole. Always the same.
  virtual bool infersParts() const { return false; }
  /// Those of a layer's voxels that belong to a part, as inferLayer has them; the others are left
  /// alone.
  virtual void inferLayerOf(const BrickPart& part, std::int64_t z, float* values) const
  {
    this->inferLayer(part.key, z, values);
  }

  /// Bricks that are best inferred together, by one call of infer; 0: layers, on any number of
  /// threads at once. It may change at any time, as a device may fail, and take seconds, while
  /// one is made ready.
  virtual std::int64_t bricksAtOnce() const { return 0; }

  /// All layers of `count` bricks, one brick after the other.
  virtual void infer(const BrickKey* keys, std::int64_t count, float* values,
                     const Arena& arena) const;
  /// The same of parts.
  void inferParts(const BrickPart* parts, std::int64_t count, float* values,
                  const Arena& arena) const;

  /// Layers of a brick that are in its level; all others are the last of them.
  std::int64_t layersInside(BrickKey key) const;
  /// Of a brick whose part has been inferred in all layers inside: copies the last of these to all
  /// others, and makes of voxels outside of the part what some voxel in it is. Takes no memory.
  void complete(const BrickPart& part, float* values) const;

protected:
  BlockRows rowsOf(const BrickPart& part) const;

private:
  void inferLayers(const BrickPart* parts, std::int64_t count, float* values,
                   const Arena& arena) const;
  void repeatLastLayer(BrickKey key, float* values) const;

  Hierarchy Levels;
  BlockLattice Lattice;
};

/// Bricks of any field over the unit cube: levels hold its values at the voxels, or the mean over
/// 2 x 2 x 2 points of each, as `hierarchy` says; along an axis of a single voxel all points are in
/// its middle. `cells`: of the field, whose ranges hold; may be null.
std::shared_ptr<const BrickSource>
MakeBrickSource(std::shared_ptr<const Evaluator> field, const Hierarchy& hierarchy,
                std::shared_ptr<const MacroCells> cells = nullptr);

} // namespace inr
