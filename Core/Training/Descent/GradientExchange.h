// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Description.h"
#include "Core/Parallel.h"
#include "Core/Training/Descent/GridGradient.h"
#include "Core/Training/Runtime/TrainingGroup.h"

#include <cstddef>
#include <cstdint>
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

/// Bytes that a process takes to add up gradients of a model with those of so many processes: its
/// share of the grid's and of theirs on the way, and the network's of all, which a group may hold
/// twice.
std::int64_t ExchangeBytes(const Layout& shape, int processes);

/// Adds up what the processes of a group found for their shares of a mini-batch, in the order of
/// ranks, so that all have the same sums, bit for bit. Of the grid only lines that were touched are
/// sent. Each process adds up an equal part of the grid and tells the others: what a process sends
/// and receives then hardly grows with their number. Nothing else is done meanwhile: packing and
/// adding up 4 MiB while others are on their way gained nothing where every core trains
/// (terascale-ranks.json says what an exchange takes).
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

  /// That were taken for the grid's gradients; the same from the first sum on.
  std::int64_t bytesHeld() const
  {
    return static_cast<std::int64_t>(this->Sent.capacity() + this->Received.bytes.capacity());
  }

  /// How long all that took so far.
  const ExchangeTimes& times() const { return this->Times; }

private:
  using Pieces = std::vector<const GridGradient::Piece*>;

  void makeRoom(std::size_t pieces);
  void sumPieces(GridGradient& grid, std::size_t begin, std::size_t end);
  std::size_t pack(GridGradient& grid, const Pieces& pieces, std::size_t at);
  void addUp(GridGradient& grid, const Pieces& pieces,
             const std::vector<const char*>& messages) const;

  const TrainingGroup& Group;
  const Arena& Threads;
  ExchangeTimes Times;
  std::vector<char> Sent;
  GatheredBytes Received;
};

} // namespace inr
