// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/glm.hpp>
#include <glm/gtc/type_precision.hpp>

#include <cstdint>

namespace inr {

/// Points or cells of a grid of `dims`, all positive. They are numbered x fastest.
template <typename T> INR_HOST_DEVICE constexpr T GridCount(const glm::vec<3, T>& dims)
{
  return dims.x * dims.y * dims.z;
}
template <typename T>
INR_HOST_DEVICE constexpr T GridNumber(const glm::vec<3, T>& at, const glm::vec<3, T>& dims)
{
  return at.x + dims.x * (at.y + dims.y * at.z);
}
template <typename T>
INR_HOST_DEVICE constexpr glm::vec<3, T> GridPlace(T number, const glm::vec<3, T>& dims)
{
  const T row = number / dims.x;
  return {number % dims.x, row % dims.y, row / dims.y};
}

/// Some of them: a box.
struct GridBox
{
  glm::i64vec3 first{0};
  glm::i64vec3 size{0};

  INR_HOST_DEVICE glm::i64vec3 end() const { return this->first + this->size; }
  INR_HOST_DEVICE std::int64_t count() const { return GridCount(this->size); }
  /// The k-th of the box.
  INR_HOST_DEVICE glm::i64vec3 at(std::int64_t k) const
  {
    return this->first + GridPlace(k, this->size);
  }
};

} // namespace inr
