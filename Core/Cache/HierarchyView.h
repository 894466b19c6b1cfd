// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickKey.h"
#include "Core/HostDevice.h"

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// A level of a Hierarchy, which says what the numbers mean.
struct HierarchyLevel
{
  glm::i64vec3 size;
  glm::i64vec3 bricks;
  glm::dvec3 scale;
  glm::dvec3 bias;
  glm::dvec3 brickScale;
  glm::dvec3 brickBias;
  std::int32_t points; ///< per voxel and axis
};

struct BrickLocation
{
  BrickId brick;
  glm::dvec3 local; ///< in the brick's voxels, in [0, brickDims - 1]
};

/// A Hierarchy as plain data, whose levels lie in the memory of whoever reads it.
class HierarchyView
{
public:
  HierarchyView() = default;
  INR_HOST_DEVICE HierarchyView(const HierarchyLevel* levels, int count,
                                const glm::ivec3& brickDims)
      : Levels(levels), Count(count), BrickDims(brickDims)
  {}

  INR_HOST_DEVICE int levels() const { return this->Count; }
  INR_HOST_DEVICE const HierarchyLevel& level(int level) const { return this->Levels[level]; }
  INR_HOST_DEVICE const glm::ivec3& brickDims() const { return this->BrickDims; }

  /// Whether a level is on the way to finer ones. Where its voxels are means of 2 x 2 x 2 points,
  /// as many as the next level has voxels in its place and points for these, those come as soon
  /// without it.
  INR_HOST_DEVICE bool isOnTheWay(int level) const
  {
    return level == 0 || this->Levels[level].points == this->Levels[level - 1].points;
  }

  INR_HOST_DEVICE glm::i64vec3 firstVoxel(const BrickId& id) const
  {
    return id.at * glm::i64vec3(this->BrickDims - 1);
  }

  /// See Hierarchy.
  INR_HOST_DEVICE BrickLocation locate(int level, const glm::dvec3& index) const
  {
    const HierarchyLevel& at = this->Levels[level];
    const glm::dvec3 place = glm::clamp(index * at.scale + at.bias, glm::dvec3(0.0),
                                        glm::dvec3(at.size - std::int64_t{1}));
    // Truncation is floor for what is not negative; the last voxel belongs to the brick before it.
    const glm::i64vec3 brick(place / glm::dvec3(this->BrickDims - 1));
    const BrickId id{level, glm::min(brick, at.bricks - std::int64_t{1})};
    return {id, place - glm::dvec3(this->firstVoxel(id))};
  }

private:
  const HierarchyLevel* Levels = nullptr;
  int Count = 0;
  glm::ivec3 BrickDims{2};
};

} // namespace inr
