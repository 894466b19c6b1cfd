// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/Kernels/RayOrder.h"

#include <array>
#include <cstdint>

namespace inr {
namespace cuda {

/// Lets the rays of a window of a picture come as far as they do with the bricks that are there.
template <class Machine> class RayTurns
{
public:
  static constexpr std::int64_t BytesPerRay = 4 * sizeof(std::uint32_t); ///< of a window

  /// `windowSize`: rays in a window, at most.
  RayTurns(Machine& machine, std::int64_t windowSize)
      : Where(machine), Later{machine.template allocate<std::uint32_t>(windowSize),
                              machine.template allocate<std::uint32_t>(windowSize)},
        Waiters{machine.template allocate<std::uint32_t>(windowSize),
                machine.template allocate<std::uint32_t>(windowSize)},
        Counts(machine.template allocate<std::uint64_t>(CountOfCounts))
  {}

  /// All rays of a window are to begin.
  void beginWindow(const RayOrder& order, std::int64_t first, std::int64_t rays)
  {
    this->Order = order;
    this->First = first;
    this->Waiting = rays;
    this->Begins = true;
  }
  /// Rays that wait: to begin or, since run, for bricks.
  std::int64_t waiting() const { return this->Waiting; }

  /// Lets `now` of the rays that wait go on. Runs a kernel with members lists and begin as of
  /// MarchRays, launch by launch: its Turns say how far each lets rays come, the last one without
  /// limit. Waits once, to be told how many rays wait: if none, all is done.
  template <class Kernel> void run(Kernel kernel, std::int64_t now)
  {
    const int next = 1 - this->Current;
    this->setNow(now);
    this->clear(WaitingOf + next);
    kernel.lists = this->listsInto(next);
    kernel.begin = this->Begins;
    int out = 0;
    for (const int stepsPerRay : Kernel::Turns) {
      this->clear(Begun);
      this->clear(LaterOf + out);
      kernel.lists.later = this->Later[out].data();
      kernel.lists.laterCount = this->count(LaterOf + out);
      kernel.lists.most = stepsPerRay;
      this->Where.run(kernel, now);
      kernel.lists.now = kernel.lists.later;
      kernel.lists.nowCount = kernel.lists.laterCount;
      kernel.begin = false;
      out = 1 - out;
    }
    std::uint64_t waiting = 0;
    this->Where.toHost(&waiting, this->count(WaitingOf + next), 1);
    this->append(now, next, static_cast<std::int64_t>(waiting));
    this->Current = next;
    this->Begins = false;
  }

private:
  enum Count { Now, Begun, LaterOf, WaitingOf = LaterOf + 2, CountOfCounts = WaitingOf + 2 };

  using List = typename Machine::template Array<std::uint32_t>;

  /// From what waits into what waits `next`; where else rays go each turn says for itself.
  RayLists listsInto(int next) const
  {
    RayLists lists{};
    lists.order = this->Order;
    lists.first = this->First;
    lists.now = this->Begins ? nullptr : this->Waiters[this->Current].data();
    lists.nowCount = this->count(Now);
    lists.begun = this->count(Begun);
    lists.waiting = this->Waiters[next].data();
    lists.waitingCount = this->count(WaitingOf + next);
    return lists;
  }

  std::uint64_t* count(int which) const { return this->Counts.data() + which; }
  void clear(int which) { this->Where.fill(this->count(which), 0, 1); }
  /// Before anything of a turn is begun: a copy is waited for.
  void setNow(std::int64_t rays)
  {
    const auto value = static_cast<std::uint64_t>(rays);
    this->Where.toMachine(this->count(Now), &value, 1);
  }
  /// Those behind the first `now` go on waiting, behind those that wait again: else none would ever
  /// find what it has waited for, where there is little room.
  void append(std::int64_t now, int next, std::int64_t waiting)
  {
    const std::int64_t rest = this->Waiting - now;
    if (rest > 0) {
      this->Where.copy(this->Waiters[next].data() + waiting,
                       this->Waiters[this->Current].data() + now, rest);
    }
    this->Waiting = waiting + rest;
  }

  Machine& Where;
  std::array<List, 2> Later;
  std::array<List, 2> Waiters;
  typename Machine::template Array<std::uint64_t> Counts;
  RayOrder Order{};
  std::int64_t First = 0;
  std::int64_t Waiting = 0;
  int Current = 0; ///< list of those that wait
  bool Begins = false;
};

} // namespace cuda
} // namespace inr
