// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/TableIntervals.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace inr {
namespace {

constexpr double Tolerance = 1.0 / 255;

struct Bend
{
  double place;
  double change; ///< of the slope there, over the whole table

  /// By how much a table of so many intervals cuts it off: most in the middle of one.
  double error(int intervals) const
  {
    const double position = this->place * intervals;
    const double within = position - std::floor(position);
    return this->change / intervals * within * (1 - within);
  }
};

/// The bend between two entries, from the slopes before and behind them.
Bend BendAt(double place, const std::vector<glm::vec4>& fine)
{
  const auto intervals = static_cast<int>(fine.size()) - 1;
  const auto k =
      static_cast<std::size_t>(std::clamp(static_cast<int>(place * intervals), 1, intervals - 2));
  const glm::vec4 change = glm::abs((fine[k + 2] - fine[k + 1]) - (fine[k] - fine[k - 1]));
  return {place, intervals * double{std::max({change.r, change.g, change.b, change.a})}};
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

int IntervalsForBends(const std::vector<double>& places, const std::vector<glm::vec4>& fine,
                      int least)
{
  constexpr std::size_t fewBends = 256;
  const auto finest = static_cast<int>(fine.size()) - 1;
  std::vector<Bend> bends; // that might matter
  for (const double place : places) {
    const Bend bend = BendAt(place, fine);
    if (place > 0 && place < 1 && bend.change > 4 * Tolerance * least) {
      bends.push_back(bend);
    }
  }
  if (bends.size() > fewBends) { // there is no number that suits all
    return finest;
  }
  int best = least;
  double smallest = std::numeric_limits<double>::infinity();
  for (int intervals = least; intervals <= finest && smallest > Tolerance; ++intervals) {
    double error = 0;
    for (const Bend& bend : bends) {
      error = std::max(error, bend.error(intervals));
    }
    if (error < smallest) {
      best = intervals;
      smallest = error;
    }
  }
  return best;
}

} // namespace inr
