// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"

#include <glm/gtc/type_precision.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace inr {

/// Voxels [low, high] along an axis.
struct VoxelSpan
{
  std::int64_t low;
  std::int64_t high;

  std::int64_t count() const { return this->high - this->low + 1; }
};

inline glm::i64vec3 LowOf(const VoxelSpan (&spans)[3])
{
  return {spans[0].low, spans[1].low, spans[2].low};
}
inline glm::i64vec3 SizeOf(const VoxelSpan (&spans)[3])
{
  return {spans[0].count(), spans[1].count(), spans[2].count()};
}

/// A box of values, x fastest.
struct ValueBox
{
  explicit ValueBox(const glm::i64vec3& size)
      : size(size), values(static_cast<std::size_t>(GridCount(size)))
  {}

  ValueBox(const glm::i64vec3& size, std::vector<float> values)
      : size(size), values(std::move(values))
  {}

  std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
  {
    return static_cast<std::size_t>(GridNumber({x, y, z}, this->size));
  }
  std::int64_t stride(int axis) const
  {
    return axis == 0 ? 1 : axis == 1 ? this->size.x : this->size.x * this->size.y;
  }

  std::int64_t count() const { return GridCount(this->size); }

  glm::i64vec3 size;
  std::vector<float> values;
};

} // namespace inr
