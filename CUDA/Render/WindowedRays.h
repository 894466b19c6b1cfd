// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Render/RayThrottle.h"
#include "CUDA/Render/RayTurns.h"
#include "Core/Error.h"
#include "Core/Render/Tiles/TileLoop.h"
#include "Core/Render/Tiles/WorkLimit.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>

namespace inr {
namespace cuda {

/// The rays of a picture, window by window: as many at once as have memory to wait in. `Progress`:
/// of a ray that waits.
template <class Machine, class Cache, class Progress> class WindowedRays
{
public:
  WindowedRays(Machine& machine, Cache& cache, std::int64_t windowSize)
      : Where(machine), Bricks(cache), WindowSize(windowSize)
  {}

  /// Runs a kernel like MarchRays, but for its members of lists, over all rays, once: none of them
  /// may wait.
  template <class Kernel>
  void runOnce(const Kernel& kernel, const RayOrder& order, const std::function<bool()>& keepGoing)
  {
    this->begin(order);
    while (!this->done()) {
      this->requireGoingOn(keepGoing);
      this->advance(kernel);
    }
  }

  /// All rays of a picture are to begin.
  void begin(const RayOrder& order)
  {
    this->reserve(std::min(order.rays(), this->WindowSize));
    this->Order = order;
    this->First = 0;
    this->beginWindow();
  }
  bool done() const { return this->First >= this->Order.rays(); } ///< all have come to their end

  /// Goes on by such a kernel with OnMiss::Stop, with every brick that rays stop for, until all
  /// have come to their end or the time is over: then some have come further, which `cameFurther`
  /// tells, as what was loaded may be gone at the next call. In between that is to be called with
  /// the same kernel, and other rays are not. `maximumRequests`: see WorkLimit.
  template <class Kernel, class CameFurther>
  void goOn(const Kernel& kernel, const WorkLimit& limit, int maximumRequests,
            const std::function<bool()>& keepGoing, const CameFurther& cameFurther)
  {
    const bool counts = limit.isLimited() && !limit.isTimed();
    const std::int64_t most = counts ? maximumRequests : this->Bricks.capacity();
    const auto inTime = [&] { return !limit.endsWithin(0); };
    while (!this->done()) {
      RequireGoing(keepGoing);
      this->Bricks.beginFrame();
      const bool wait = this->advance(kernel);
      if (!inTime() && cameFurther()) {
        this->Bricks.forgetRequests();
        return;
      }
      if (wait) {
        this->load(most, [&] { return counts || inTime(); });
      }
    }
  }

private:
  /// Else what some rays wish for would come in with the next picture's.
  void requireGoingOn(const std::function<bool()>& keepGoing)
  {
    try {
      RequireGoing(keepGoing);
    } catch (const Error&) {
      this->Bricks.forgetRequests();
      throw;
    }
  }

  using Rays = typename Machine::template Array<Progress>;

  void beginWindow()
  {
    const std::int64_t rays = std::min(this->WindowSize, this->Order.rays() - this->First);
    this->Turns->beginWindow(this->Order, this->First, rays);
    this->Throttle.beginWindow(rays);
  }

  /// The present window's rays, as far as they come; whether any of them wait. If none do, it is
  /// the next window's turn.
  template <class Kernel> bool advance(Kernel kernel)
  {
    kernel.progress = this->Room->data();
    kernel.cache = this->Bricks.view();
    this->Turns->run(kernel, this->Throttle.atOnce(this->Turns->waiting()));
    if (this->Turns->waiting() > 0) {
      return true;
    }
    this->First += this->WindowSize;
    if (!this->done()) {
      this->beginWindow();
    }
    return false;
  }

  /// What the waiting rays want, at most so many bricks, as long as there is time for more.
  void load(std::int64_t most, const std::function<bool()>& goesOn)
  {
    const std::int64_t waiting = this->Turns->waiting();
    const auto loaded = this->Bricks.load(most, true, goesOn);
    if (loaded.loaded == 0 && this->Throttle.atOnce(waiting) == 1) {
      this->Bricks.clear();
    }
    this->Throttle.adapt({loaded.loaded, this->Bricks.capacity(), loaded.full}, waiting);
  }

  void reserve(std::int64_t rays)
  {
    if (!this->Room || this->Room->size() < rays) {
      this->Turns.reset();
      this->Room.reset();
      this->Where.requireFree(
          rays * (static_cast<std::int64_t>(sizeof(Progress)) + RayTurns<Machine>::BytesPerRay),
          "what the rays of a picture wait in");
      this->Room.emplace(this->Where.template allocate<Progress>(rays));
      this->Turns.emplace(this->Where, rays);
    }
  }

  Machine& Where;
  Cache& Bricks;
  std::int64_t WindowSize; ///< rays, at most
  RayOrder Order{};
  std::int64_t First = 0; ///< ray of the window
  RayThrottle Throttle;
  std::optional<Rays> Room;
  std::optional<RayTurns<Machine>> Turns;
};

} // namespace cuda
} // namespace inr
