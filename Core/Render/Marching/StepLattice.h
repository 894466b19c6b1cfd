// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace inr {

/// 2^power, for the exponents of ordinary numbers.
INR_HOST_DEVICE inline double PowerOfTwo(int power)
{
  const auto bits = static_cast<std::uint64_t>(1023 + power) << 52;
  double value;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

/// How many of 0, 1, 2 ... are below `end`; at least 1, at most `most`.
INR_HOST_DEVICE inline int CountBelow(double end, double most)
{
  const double enough = glm::min(end, most);
  const int whole = static_cast<int>(enough);
  return glm::max(1, whole + (static_cast<double>(whole) < enough ? 1 : 0));
}

/// Where the block of the lattice ends that `place` is in; blocks are `length` long, the first one
/// begins at 0.
INR_HOST_DEVICE inline double BlockEnd(double place, double length)
{
  return (std::floor(place / length) + 1.0) * length;
}

} // namespace inr
