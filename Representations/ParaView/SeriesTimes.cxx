// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesTimes.h"

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

bool IsKnown(double time) { return !std::isnan(time); }

/// The distance of `count` steps from `first`, which is known, to the next known one; 1 where there
/// is none.
double Spacing(const std::vector<double>& times, std::size_t first)
{
  for (std::size_t k = first + 1; k < times.size(); ++k) {
    if (IsKnown(times[k])) {
      return (times[k] - times[first]) / static_cast<double>(k - first);
    }
  }
  return 1;
}

bool AreDifferent(std::vector<double> times)
{
  std::sort(times.begin(), times.end());
  return std::adjacent_find(times.begin(), times.end()) == times.end();
}

} // namespace

std::vector<double> SeriesTimes(std::vector<double> told)
{
  const auto known = std::find_if(told.begin(), told.end(), IsKnown);
  if (known == told.end()) {
    return {};
  }
  for (auto k = known; k != told.begin(); --k) {
    *(k - 1) = *k - 1;
  }
  for (std::size_t k = 1; k < told.size(); ++k) {
    if (!IsKnown(told[k])) {
      told[k] = told[k - 1] + Spacing(told, k - 1);
    }
  }
  return AreDifferent(told) ? told : std::vector<double>();
}

} // namespace inr
