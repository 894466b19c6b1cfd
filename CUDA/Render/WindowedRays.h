// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/RayTurns.h"
#include "Core/Error.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>

namespace inr {
namespace cuda {

/// Throws Error(Cancelled) when `keepGoing`, which may be empty, says so.
inline void RequireGoingOn(const std::function<bool()>& keepGoing)
{
  if (keepGoing && !keepGoing()) {
    throw Error(ErrorCode::Cancelled, "rendering stopped on request");
  }
}

/// The rays of a picture, window by window: as many at once as have memory to wait in. `Progress`:
/// of a ray that waits.
template <class Machine, class Cache, class Progress> class WindowedRays
{
public:
  /// `most`: rays of a window.
  WindowedRays(Machine& machine, Cache& cache, std::int64_t most)
      : Where(machine), Bricks(cache), Most(most)
  {}

  /// Runs a kernel like MarchRays, but for its members of lists and turns, over all rays, once:
  /// with OnMiss::Stop those that miss a brick do not come to their end.
  template <class Kernel> void runOnce(Kernel kernel, const RayOrder& order)
  {
    this->forEachWindow(kernel, order, [&](const Kernel& ready) { this->Turns->run(ready); });
  }

  /// The same until all rays have come to their end, with every brick that they stop for.
  template <class Kernel>
  void runToEnd(Kernel kernel, const RayOrder& order, const std::function<bool()>& keepGoing)
  {
    this->forEachWindow(kernel, order, [&](Kernel ready) {
      while (true) {
        RequireGoingOn(keepGoing);
        this->Bricks.beginFrame();
        ready.cache = this->Bricks.view();
        this->Turns->run(ready);
        if (this->Turns->waiting() == 0) {
          break;
        }
        this->load();
      }
    });
  }

private:
  using Rays = typename Machine::template Array<Progress>;

  template <class Kernel, class Run>
  void forEachWindow(Kernel& kernel, const RayOrder& order, const Run& run)
  {
    const std::int64_t rays = order.rays();
    this->reserve(std::min(rays, this->Most));
    kernel.progress = this->Room->data();
    for (std::int64_t first = 0; first < rays; first += this->Most) {
      this->Waiting = std::min(this->Most, rays - first);
      this->Turns->beginWindow(order, first, this->Waiting);
      kernel.cache = this->Bricks.view();
      run(kernel);
    }
  }

  /// What the waiting rays want. If bricks that the others have just used leave no room, fewer go
  /// on at once, and in the end a single ray, whose next sample has what it needs when nothing else
  /// is there.
  void load()
  {
    const auto loaded = this->Bricks.load(this->Bricks.capacity(), true);
    const std::int64_t atOnce = this->Turns->limit();
    if (loaded.loaded == 0 && atOnce == 1) {
      this->Bricks.clear();
    }
    // More again only when a ray has ended: else a number that is too large and its half would take
    // turns for ever.
    const bool ended = this->Turns->waiting() < this->Waiting;
    const bool few = 4 * loaded.loaded < this->Bricks.capacity();
    const bool crowded = loaded.full && (few || !ended);
    this->Turns->limit(crowded ? atOnce / 2 : (ended ? 2 * atOnce : atOnce));
    this->Waiting = this->Turns->waiting();
  }

  void reserve(std::int64_t rays)
  {
    if (!this->Room || this->Room->size() < rays) {
      this->Turns.reset();
      this->Room.reset();
      this->Room.emplace(this->Where.template allocate<Progress>(rays));
      this->Turns.emplace(this->Where, rays);
    }
  }

  Machine& Where;
  Cache& Bricks;
  std::int64_t Most;
  std::int64_t Waiting = 0; ///< rays of the window, when bricks were last loaded
  std::optional<Rays> Room;
  std::optional<RayTurns<Machine>> Turns;
};

} // namespace cuda
} // namespace inr
