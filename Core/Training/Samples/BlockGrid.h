// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Samples/HalvedCube.h"
#include "Core/Training/Volume/Volume.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace inr {

/// A volume in blocks that are read one at a time. Rows stay whole as long as blocks of at least
/// ThinnestBlock voxels allow, since what is together in a file is read together; the other two
/// axes are divided alike.
class BlockGrid
{
public:
  static constexpr std::int64_t ThinnestBlock = 8;

  /// Blocks of at most `mostVoxels` voxels with a `margin` around them, see VolumeReader, or as
  /// near to that as blocks of a voxel are.
  BlockGrid(const glm::i64vec3& dims, std::int64_t mostVoxels, int margin = 0);

  const glm::i64vec3& dims() const { return this->Dims; } ///< of the volume
  std::int64_t count() const { return this->Boxes.count(); }

  /// The block that a position lies in.
  std::int64_t blockAt(const glm::vec3& position) const;

  /// In the unit cube.
  const glm::vec3& corner(std::int64_t block) const
  {
    return this->Boxes.corners[static_cast<std::size_t>(block)];
  }
  const glm::vec3& extent() const { return this->Boxes.extent; }

  /// The voxels whose centres lie in a block: of all blocks together, every voxel once. May be
  /// none.
  GridBox ownVoxels(std::int64_t block) const;

  /// The voxels that positions in a block are interpolated from: its own and those next to them.
  GridBox voxels(std::int64_t block) const;

  /// What voxels() of all blocks hold, with the margin, over the voxels of the volume: 1 and
  /// somewhat.
  double readShare() const;

private:
  /// Of a block, in voxels: voxel i is at i.
  std::pair<glm::dvec3, glm::dvec3> edges(std::int64_t block) const;

  glm::i64vec3 Dims;
  int Margin;
  std::vector<int> Axes; ///< of the halvings
  HalvedCube Boxes;
};

} // namespace inr
