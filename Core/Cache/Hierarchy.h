// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// A brick: its level (0 = full resolution) and its place among that level's bricks.
struct BrickId
{
  int level;
  glm::i64vec3 at;
};

/// A brick in 62 bits: level, z, y, x. Keys of a level sort by z, then y, then x.
using BrickKey = std::uint64_t;
constexpr int BrickAxisBits = 19; ///< x takes the lowest

inline BrickKey KeyOf(const BrickId& id)
{
  const auto word = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
  return (((word(id.level) << BrickAxisBits | word(id.at.z)) << BrickAxisBits | word(id.at.y))
          << BrickAxisBits) |
         word(id.at.x);
}

inline BrickId IdOf(BrickKey key)
{
  const auto axis = [key](int place) {
    constexpr BrickKey mask = (BrickKey{1} << BrickAxisBits) - 1;
    return static_cast<std::int64_t>(key >> (place * BrickAxisBits) & mask);
  };
  return {static_cast<int>(key >> (3 * BrickAxisBits)), {axis(0), axis(1), axis(2)}};
}

/// Voxels along an axis of a level, where level 0 has `voxels`: half as many for each level,
/// rounded up.
inline std::int64_t VoxelsAtLevel(std::int64_t voxels, int level)
{
  const std::int64_t together = std::int64_t{1} << level;
  return (voxels + together - 1) / together; // rounding up level by level is the same
}

/// The levels of a volume and their bricks.
///
/// Level 0 has the volume's voxels, level l + 1 half as many along every axis, rounded up; voxel v
/// of a level with n stands at u = (v + 0.5)/n. Neighbouring bricks share a layer of voxels, so
/// that any point lies between voxels of a single brick. The last level is one brick.
class Hierarchy
{
public:
  static constexpr int SmallestBrick = 4; ///< voxels per side
  static constexpr int LargestBrick = 1024;

  /// `brickSize`: voxels per side, as said. Throws Error(InvalidArgument) for sizes out of range
  /// and Error(TooLarge) for more than 2^19 bricks along an axis.
  Hierarchy(const glm::i64vec3& dims, int brickSize);

  int levels() const { return static_cast<int>(this->Levels.size()); }
  const glm::i64vec3& dims() const { return this->size(0); }
  const glm::i64vec3& size(int level) const { return this->at(level).size; }     ///< in voxels
  const glm::i64vec3& bricks(int level) const { return this->at(level).bricks; } ///< per axis

  /// Voxels stored per brick and axis: the brick size, or less where the volume is thinner.
  const glm::ivec3& brickDims() const { return this->BrickDims; }
  std::int64_t voxelsPerBrick() const
  {
    return std::int64_t{1} * this->BrickDims.x * this->BrickDims.y * this->BrickDims.z;
  }
  glm::i64vec3 firstVoxel(const BrickId& id) const
  {
    return id.at * glm::i64vec3(this->BrickDims - 1);
  }
  BrickKey coarsest() const { return KeyOf({this->levels() - 1, glm::i64vec3(0)}); }

  /// Position p in voxels of level 0 (voxel i at i) is p * scale + bias in voxels of `level`.
  const glm::dvec3& scale(int level) const { return this->at(level).scale; }
  const glm::dvec3& bias(int level) const { return this->at(level).bias; }
  /// And p * brickScale + brickBias in bricks, rounded down, is the brick that it lies in.
  const glm::dvec3& brickScale(int level) const { return this->at(level).brickScale; }
  const glm::dvec3& brickBias(int level) const { return this->at(level).brickBias; }

  struct Location
  {
    BrickId brick;
    glm::dvec3 local; ///< in the brick's voxels, in [0, brickDims - 1]
  };
  /// Where `level` keeps the field at a position in voxels of level 0, clamped to the voxels.
  Location locate(int level, const glm::dvec3& index) const;

private:
  struct Level
  {
    glm::i64vec3 size;
    glm::i64vec3 bricks;
    glm::dvec3 scale;
    glm::dvec3 bias;
    glm::dvec3 brickScale;
    glm::dvec3 brickBias;
  };
  const Level& at(int level) const { return this->Levels[static_cast<std::size_t>(level)]; }

  glm::ivec3 BrickDims{2};
  std::vector<Level> Levels;
};

} // namespace inr
