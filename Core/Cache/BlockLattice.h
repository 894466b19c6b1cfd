// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstdint>

namespace inr {

/// How the interpolation cells of a brick make blocks: cubes of `edge` cells per side, fewer at the
/// far ends. Neighbouring blocks share the voxels between them, so that what is interpolated
/// anywhere in a block is within the range of its voxels.
struct BlockLattice
{
  static constexpr int Most = 8; ///< blocks per axis

  /// `brickDims`: voxels per axis, at least 2.
  explicit BlockLattice(const glm::ivec3& brickDims);

  int edge;             ///< at least 4, so that ranges take little beside the voxels
  glm::ivec3 count;     ///< of blocks per axis
  glm::ivec3 lastVoxel; ///< of the brick

  std::int64_t blocks() const { return GridCount(glm::i64vec3(this->count)); }

  /// Of blocks or of voxels, both ends included.
  struct Span
  {
    int first;
    int last;
  };
  /// The blocks along an axis that share a voxel, of which there are one or two.
  Span blocksAt(int voxel, int axis) const
  {
    return {std::max(voxel - 1, 0) / this->edge,
            std::min(voxel / this->edge, this->count[axis] - 1)};
  }
  /// The voxels of such blocks.
  Span voxelsOf(const Span& blocks, int axis) const
  {
    return {blocks.first * this->edge,
            std::min((blocks.last + 1) * this->edge, this->lastVoxel[axis])};
  }
};

} // namespace inr
