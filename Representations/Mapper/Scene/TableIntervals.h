// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace inr {

/// How many equal intervals from `low` to `high`, of the value or, where both are positive and that
/// is asked for, of its logarithm, are as short as what is between the two closest of the rising
/// `nodes` in there: 0 where there are no two, the largest integer where it cannot say how many.
/// Nodes at one place are one.
int IntervalsBetween(const std::vector<double>& nodes, double low, double high, bool logarithmic);

/// Where a function bends.
struct Bend
{
  double place;  ///< from 0, a table's first entry, to 1, its last
  double change; ///< of the slope there, over the whole table
};

/// The fewest intervals, from `least` to `most`, with which a table is wrong by no more than a step
/// of 8 bits where its function bends; where none are enough, those with which it is wrong by the
/// least.
int IntervalsForBends(const std::vector<Bend>& bends, int least, int most);

} // namespace inr
