// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/Hierarchy.h"

#include "Core/Cache/LevelPoints.h"
#include "Core/Error.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <cmath>
#include <string>

namespace inr {

namespace {

constexpr std::int64_t MostBricks = (std::int64_t{1} << BrickAxisBits) - 1; // along an axis

std::int64_t BricksAlong(std::int64_t voxels, std::int64_t stride)
{
  return voxels <= 1 ? 1 : (voxels - 1 + stride - 1) / stride;
}

void RequireSizes(const glm::i64vec3& dims, int brickSize)
{
  if (brickSize < Hierarchy::SmallestBrick || brickSize > Hierarchy::LargestBrick) {
    throw Error(ErrorCode::InvalidArgument,
                "bricks of " + std::to_string(brickSize) + " voxels a side; use 4 to 1024");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1) {
      throw Error(ErrorCode::InvalidArgument,
                  "a volume cannot have " + std::to_string(dims[axis]) + " voxels along an axis");
    }
    if (BricksAlong(dims[axis], brickSize - 1) > MostBricks) {
      throw Error(ErrorCode::TooLarge, std::to_string(dims[axis]) +
                                           " voxels along an axis make too many bricks of " +
                                           std::to_string(brickSize) + "; use larger bricks");
    }
  }
}

} // namespace

Hierarchy::Hierarchy(const glm::i64vec3& dims, int brickSize, const glm::i64vec3& resolution)
{
  RequireSizes(dims, brickSize);
  for (int axis = 0; axis < 3; ++axis) {
    const auto side = glm::clamp<std::int64_t>(dims[axis], 2, brickSize);
    this->BrickDims[axis] = static_cast<int>(side);
  }
  do {
    HierarchyLevel level;
    for (int axis = 0; axis < 3; ++axis) {
      level.size[axis] = VoxelsAtLevel(dims[axis], this->levels());
      level.bricks[axis] = BricksAlong(level.size[axis], this->BrickDims[axis] - 1);
    }
    level.points = PointsPerAxis(dims, this->levels(), resolution);
    level.scale = glm::dvec3(level.size) / glm::dvec3(dims);
    level.bias = 0.5 * level.scale - 0.5;
    level.brickScale = level.scale / glm::dvec3(this->BrickDims - 1);
    level.brickBias = level.bias / glm::dvec3(this->BrickDims - 1);
    this->Levels.push_back(level);
  } while (this->Levels.back().bricks != glm::i64vec3(1) ||
           glm::any(glm::greaterThan(this->Levels.back().size, glm::i64vec3(LargestCoarsest))));
}

} // namespace inr
