// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Parallel.h"
#include "Core/Training/GridGradient.h"
#include "Core/Training/TrainingGroup.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace inr {

/// Wall time, in seconds, of a process that trains with others.
struct ExchangeTimes
{
  double waiting = 0;    ///< until the others had their gradients, too
  double exchanging = 0; ///< in which gradients were told and added up
};

/// Adds up what the processes of a group found for their shares of a mini-batch, in the order of
/// ranks, so that all have the same sums, bit for bit. Of the grid only lines that were touched are
/// sent.
class GradientExchange
{
public:
  GradientExchange(const TrainingGroup& group, const Arena& arena) : Group(group), Threads(arena) {}

  /// As TrainingGroup::together, with an eye on how long the others take.
  void together(const std::function<void()>& work);

  /// `weights` and `grid` become the sums; returns that of `loss`. Nothing where one process has
  /// nothing, since it was stopped: then the step is not to be done.
  std::optional<double> sum(const std::optional<double>& loss, float* weights, std::size_t count,
                            GridGradient& grid);

  /// How long all that took so far.
  const ExchangeTimes& times() const { return this->Times; }

private:
  void sumPieces(GridGradient& grid, std::size_t begin, std::size_t end);
  void pack(GridGradient& grid, std::size_t begin, std::size_t end);
  void addUp(GridGradient& grid, std::size_t begin, std::size_t end) const;

  const TrainingGroup& Group;
  const Arena& Threads;
  ExchangeTimes Times;
  std::vector<std::size_t> Begins; ///< in Mine, of the pieces' parts; then its end
  std::vector<char> Mine;
  GatheredBytes All;
};

} // namespace inr
