// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/TableIntervals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace inr {
namespace {

constexpr double Tolerance = 1.0 / 255;

/// By how much a table of so many intervals cuts it off: most in the middle of one.
double CutOff(const Bend& bend, int intervals)
{
  const double position = bend.place * intervals;
  const double within = position - std::floor(position);
  return bend.change / intervals * within * (1 - within);
}

} // namespace

int IntervalsBetween(const std::vector<double>& nodes, double low, double high, bool logarithmic)
{
  double most = 0;
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const double before = nodes[k - 1];
    const double behind = nodes[k];
    if (behind <= before || behind <= low || before >= high || (logarithmic && before <= 0)) {
      continue;
    }
    most = std::max(most, logarithmic ? std::log(high / low) / std::log(behind / before)
                                      : (high - low) / (behind - before));
  }
  constexpr int largest = std::numeric_limits<int>::max();
  return most < largest ? static_cast<int>(std::ceil(most)) : largest; // or the ratio rounds to 1
}

int IntervalsForBends(const std::vector<Bend>& bends, int least, int most)
{
  int best = least;
  double smallest = std::numeric_limits<double>::infinity();
  for (int intervals = least; intervals <= most && smallest > Tolerance; ++intervals) {
    double error = 0;
    for (const Bend& bend : bends) {
      error = std::max(error, CutOff(bend, intervals));
    }
    if (error < smallest) {
      best = intervals;
      smallest = error;
    }
  }
  return best;
}

} // namespace inr
