// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// A value of the field as a level has it.
struct KnownValue
{
  std::int64_t at = -2; ///< place on the ray, of the end of an interval of its lattice; -2 = none
  int level = -1;
  float value = 0;
};

} // namespace inr
