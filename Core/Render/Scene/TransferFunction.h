// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec4.hpp>

#include <vector>

namespace inr {

/// Colour and opacity over data values, as a table.
///
/// Entry k of n holds straight RGB and the opacity per unit distance at the value
/// low + (high - low) * k/(n - 1), or at low * (high/low)^(k/(n - 1)) when `logarithmic` (low and
/// high positive). Linear between entries; `below` and `above` hold outside [low, high].
struct TransferFunction
{
  double low = 0;
  double high = 1;
  bool logarithmic = false;
  std::vector<glm::vec4> table; ///< 2 to 65536 entries, alpha in [0, 1]
  glm::vec4 below{0};
  glm::vec4 above{0};

  bool operator==(const TransferFunction& other) const
  {
    return this->low == other.low && this->high == other.high &&
           this->logarithmic == other.logarithmic && this->table == other.table &&
           this->below == other.below && this->above == other.above;
  }
  bool operator!=(const TransferFunction& other) const { return !(*this == other); }
};

} // namespace inr
