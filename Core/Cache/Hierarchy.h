// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickKey.h"
#include "Core/Cache/HierarchyView.h"
#include "Core/GridBox.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// The levels of a volume and their bricks.
///
/// Level 0 has the volume's voxels, level l + 1 half as many along every axis, rounded up; voxel v
/// of a level with n stands at u = (v + 0.5)/n. Neighbouring bricks share a layer of voxels, so
/// that any point lies between voxels of a single brick. The last level is one brick of
/// LargestCoarsest voxels per side at most: large bricks leave out no level that a picture from
/// afar takes.
class Hierarchy
{
public:
  static constexpr int SmallestBrick = 4; ///< voxels per side
  static constexpr int LargestBrick = 1024;
  static constexpr int LargestCoarsest = 40; ///< voxels per side: as bricks have by default

  /// `brickSize`: voxels per side, as said. Throws Error(InvalidArgument) for sizes out of range
  /// and Error(TooLarge) for 2^19 bricks or more along an axis. `resolution`: of the field that
  /// the voxels are of, see Evaluator.
  Hierarchy(const glm::i64vec3& dims, int brickSize,
            const glm::i64vec3& resolution = glm::i64vec3(0));

  int levels() const { return static_cast<int>(this->Levels.size()); }
  const glm::i64vec3& dims() const { return this->size(0); }
  const glm::i64vec3& size(int level) const { return this->at(level).size; }     ///< in voxels
  const glm::i64vec3& bricks(int level) const { return this->at(level).bricks; } ///< per axis
  /// At which the field is asked for a voxel, per axis; see PointsPerAxis.
  int points(int level) const { return this->at(level).points; }

  /// Voxels stored per brick and axis: the brick size, or less where the volume is thinner.
  const glm::ivec3& brickDims() const { return this->BrickDims; }
  std::int64_t voxelsPerBrick() const { return GridCount(glm::i64vec3(this->BrickDims)); }
  glm::i64vec3 firstVoxel(const BrickId& id) const { return this->view().firstVoxel(id); }
  /// The brick of the next coarser level, which must exist, that shows most of the same.
  BrickId coarser(const BrickId& id) const
  {
    return {id.level + 1,
            glm::min(id.at / std::int64_t{2}, this->bricks(id.level + 1) - std::int64_t{1})};
  }
  BrickKey coarsest() const { return KeyOf({this->levels() - 1, glm::i64vec3(0)}); }

  /// Position p in voxels of level 0 (voxel i at i) is p * scale + bias in voxels of `level`.
  const glm::dvec3& scale(int level) const { return this->at(level).scale; }
  const glm::dvec3& bias(int level) const { return this->at(level).bias; }

  using Location = BrickLocation;
  /// Where `level` keeps the field at a position in voxels of level 0, clamped to the voxels.
  Location locate(int level, const glm::dvec3& index) const
  {
    return this->view().locate(level, index);
  }

  /// What code that runs anywhere reads; as long as this lives.
  HierarchyView view() const { return {this->Levels.data(), this->levels(), this->BrickDims}; }

private:
  const HierarchyLevel& at(int level) const
  {
    return this->Levels[static_cast<std::size_t>(level)];
  }

  glm::ivec3 BrickDims{2};
  std::vector<HierarchyLevel> Levels;
};

} // namespace inr
