// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec4.hpp>

#include <vector>

namespace inr {

/// How many equal intervals from `low` to `high`, of the value or, where both are positive and that
/// is asked for, of its logarithm, are as short as what is between the two closest of the rising
/// `nodes` in there: 0 where there are no two, the largest integer where it cannot say how many.
/// Nodes at one place are one.
int IntervalsBetween(const std::vector<double>& nodes, double low, double high, bool logarithmic);

/// The fewest intervals, from `least` to those of `fine`, with which a table of what `fine` is a
/// table of is wrong by no more than a step of 8 bits at `places`, where it bends; where none are
/// enough, those with which it is wrong by the least. Places are from 0, the table's first entry,
/// to 1, its last.
int IntervalsForBends(const std::vector<double>& places, const std::vector<glm::vec4>& fine,
                      int least);

} // namespace inr
