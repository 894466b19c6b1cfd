// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// A value of the field as a level has it.
struct KnownValue
{
  /// Place on the ray: the end of an interval of its lattice or, while what is behind it waits, a
  /// surface that is drawn; -2 = none.
  double at = -2;
  float value = 0;
  std::int16_t level = -1;
  /// So often what is behind it was halved, in search of the next surface, down to `until`.
  std::int16_t halvings = 0;
  double until = 0;
};

} // namespace inr
