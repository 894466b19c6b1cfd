// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"
#include "Core/Training/GridGradient.h"
#include "Core/Training/TrainingGroup.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace inr {

/// Adds up what the processes of a group found for their shares of a mini-batch, in the order of
/// ranks, so that all have the same sums, bit for bit. Of the grid only lines that were touched are
/// sent.
class GradientExchange
{
public:
  GradientExchange(const TrainingGroup& group, const Arena& arena) : Group(group), Threads(arena) {}

  const TrainingGroup& group() const { return this->Group; }

  /// `weights` and `grid` become the sums; returns that of `loss`. Nothing where one process has
  /// nothing, since it was stopped: then the step is not to be done.
  std::optional<double> sum(const std::optional<double>& loss, float* weights, std::size_t count,
                            GridGradient& grid) const;

private:
  void sumPieces(GridGradient& grid, std::size_t begin, std::size_t end) const;

  const TrainingGroup& Group;
  const Arena& Threads;
};

} // namespace inr
