// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/RangeOfValues.h"

#include <algorithm>

namespace inr {

ValueRange RangeOfValues(const float* values, std::int64_t count)
{
  constexpr std::int64_t lanes = 16; // side by side, for the compiler to make vectors of
  float low[lanes];
  float high[lanes];
  std::fill_n(low, lanes, values[0]);
  std::fill_n(high, lanes, values[0]);
  const std::int64_t whole = count - count % lanes;
  for (std::int64_t k = 0; k < whole; k += lanes) {
    for (std::int64_t lane = 0; lane < lanes; ++lane) {
      const float value = values[k + lane];
      low[lane] = value < low[lane] ? value : low[lane];
      high[lane] = value > high[lane] ? value : high[lane];
    }
  }
  for (std::int64_t k = whole; k < count; ++k) {
    low[0] = std::min(low[0], values[k]);
    high[0] = std::max(high[0], values[k]);
  }
  return {*std::min_element(low, low + lanes), *std::max_element(high, high + lanes)};
}

} // namespace inr
