// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

/// A value of the field as a level has it.
struct KnownValue
{
  /// Place on the ray: the end of an interval of its lattice or, while what is behind it waits, a
  /// surface that is drawn; -2 = none.
  double at = -2;
  int level = -1;
  float value = 0;
};

} // namespace inr
