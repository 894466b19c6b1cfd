// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/Hierarchy.h"

#include "Core/Error.h"

#include <glm/common.hpp>

#include <cmath>
#include <string>

namespace inr {

namespace {

constexpr std::uint64_t AxisMask = (std::uint64_t{1} << BrickAxisBits) - 1;
constexpr int SmallestBrick = 4;
constexpr int LargestBrick = 1024;

std::int64_t BricksAlong(std::int64_t voxels, std::int64_t stride)
{
  return voxels <= 1 ? 1 : (voxels - 1 + stride - 1) / stride;
}

void RequireSizes(const glm::i64vec3& dims, int brickSize)
{
  if (brickSize < SmallestBrick || brickSize > LargestBrick) {
    throw Error(ErrorCode::InvalidArgument,
                "bricks of " + std::to_string(brickSize) + " voxels a side; use 4 to 1024");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1) {
      throw Error(ErrorCode::InvalidArgument,
                  "a volume cannot have " + std::to_string(dims[axis]) + " voxels along an axis");
    }
    if (BricksAlong(dims[axis], brickSize - 1) > static_cast<std::int64_t>(AxisMask)) {
      throw Error(ErrorCode::TooLarge, std::to_string(dims[axis]) +
                                           " voxels along an axis make too many bricks of " +
                                           std::to_string(brickSize) + "; use larger bricks");
    }
  }
}

} // namespace

BrickKey KeyOf(const BrickId& id)
{
  const auto word = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
  return (((word(id.level) << BrickAxisBits | word(id.at.z)) << BrickAxisBits | word(id.at.y))
          << BrickAxisBits) |
         word(id.at.x);
}

BrickId IdOf(BrickKey key)
{
  const auto axis = [key](int place) {
    return static_cast<std::int64_t>(key >> (place * BrickAxisBits) & AxisMask);
  };
  return {static_cast<int>(key >> (3 * BrickAxisBits)), {axis(0), axis(1), axis(2)}};
}

Hierarchy::Hierarchy(const glm::i64vec3& dims, int brickSize)
{
  RequireSizes(dims, brickSize);
  for (int axis = 0; axis < 3; ++axis) {
    const auto side = glm::clamp<std::int64_t>(dims[axis], 2, brickSize);
    this->BrickDims[axis] = static_cast<int>(side);
  }
  glm::i64vec3 size = dims;
  do {
    Level level;
    level.size = size;
    for (int axis = 0; axis < 3; ++axis) {
      level.bricks[axis] = BricksAlong(size[axis], this->BrickDims[axis] - 1);
    }
    level.scale = glm::dvec3(size) / glm::dvec3(dims);
    level.inverseScale = 1.0 / level.scale;
    level.bias = 0.5 * level.scale - 0.5;
    this->Levels.push_back(level);
    size = (size + std::int64_t{1}) / std::int64_t{2};
  } while (this->Levels.back().bricks != glm::i64vec3(1));
}

BrickId Hierarchy::brickAt(int level, const glm::dvec3& index) const
{
  const Level& at = this->at(level);
  // Truncation is floor for what is not negative; the last voxel belongs to the brick before it.
  const glm::dvec3 place = glm::max(index * at.scale + at.bias, glm::dvec3(0.0));
  const glm::i64vec3 brick(place / glm::dvec3(this->BrickDims - 1));
  return {level, glm::min(brick, at.bricks - std::int64_t{1})};
}

Hierarchy::Location Hierarchy::locate(int level, const glm::dvec3& index) const
{
  const Level& at = this->at(level);
  const glm::dvec3 place = glm::clamp(index * at.scale + at.bias, glm::dvec3(0.0),
                                      glm::dvec3(at.size - std::int64_t{1}));
  const BrickId brick = this->brickAt(level, index);
  return {brick, place - glm::dvec3(this->firstVoxel(brick))};
}

} // namespace inr
