// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace inr {
namespace cuda {

/// How many of a window's rays go on at once. Where bricks that some have just used leave no room
/// for those that others wait for, these are fewer and fewer: in the end a single ray, whose next
/// sample has what it needs when nothing else is there.
class RayThrottle
{
public:
  /// All rays of a window are to begin.
  void beginWindow(std::int64_t rays)
  {
    this->Most = rays;
    this->Waiting = rays;
  }

  /// Of `waiting` rays, at least one.
  std::int64_t atOnce(std::int64_t waiting) const { return std::min(this->Most, waiting); }

  /// What came in for the rays that waited when they had gone on.
  struct Supply
  {
    std::int64_t loaded;   ///< bricks
    std::int64_t capacity; ///< of the cache
    bool full;             ///< there were more than fitted
  };
  /// `waiting`: rays that wait for it.
  void adapt(const Supply& supply, std::int64_t waiting)
  {
    const std::int64_t atOnce = this->atOnce(waiting);
    // More again only when a ray has ended: else a number that is too large and its half would take
    // turns for ever.
    const bool ended = waiting < this->Waiting;
    const bool few = 4 * supply.loaded < supply.capacity;
    const bool crowded = supply.full && (few || !ended);
    const std::int64_t next = crowded ? atOnce / 2 : (ended ? 2 * atOnce : atOnce);
    this->Most = std::max<std::int64_t>(next, 1);
    this->Waiting = waiting;
  }

private:
  std::int64_t Most = 0;
  std::int64_t Waiting = 0; ///< when bricks came in last
};

} // namespace cuda
} // namespace inr
