// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

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

INR_HOST_DEVICE inline BrickKey KeyOf(const BrickId& id)
{
  const auto word = [](std::int64_t value) { return static_cast<std::uint64_t>(value); };
  return (((word(id.level) << BrickAxisBits | word(id.at.z)) << BrickAxisBits | word(id.at.y))
          << BrickAxisBits) |
         word(id.at.x);
}

INR_HOST_DEVICE inline BrickId IdOf(BrickKey key)
{
  const auto axis = [key](int place) {
    constexpr BrickKey mask = (BrickKey{1} << BrickAxisBits) - 1;
    return static_cast<std::int64_t>(key >> (place * BrickAxisBits) & mask);
  };
  return {static_cast<int>(key >> (3 * BrickAxisBits)), {axis(0), axis(1), axis(2)}};
}

/// Voxels along an axis of a level, where level 0 has `voxels`: half as many for each level,
/// rounded up.
INR_HOST_DEVICE inline std::int64_t VoxelsAtLevel(std::int64_t voxels, int level)
{
  const std::int64_t together = std::int64_t{1} << level;
  return (voxels + together - 1) / together; // rounding up level by level is the same
}

/// The same along all axes.
INR_HOST_DEVICE inline glm::i64vec3 VoxelsAtLevel(const glm::i64vec3& voxels, int level)
{
  return {VoxelsAtLevel(voxels.x, level), VoxelsAtLevel(voxels.y, level),
          VoxelsAtLevel(voxels.z, level)};
}

} // namespace inr
