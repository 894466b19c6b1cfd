// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace inr {

/// What bringing bricks into a cache took.
struct BrickWork
{
  std::int64_t bricks = 0; ///< inferred, those for which there turned out to be no room included
  std::int64_t points = 0; ///< at which the field was asked for their voxels
  std::int64_t bytes = 0;  ///< of voxels moved into the cache, as they are stored

  bool operator==(const BrickWork& other) const
  {
    return this->bricks == other.bricks && this->points == other.points &&
           this->bytes == other.bytes;
  }
  void add(const BrickWork& other)
  {
    this->bricks += other.bricks;
    this->points += other.points;
    this->bytes += other.bytes;
  }
  BrickWork since(const BrickWork& before) const
  {
    return {this->bricks - before.bricks, this->points - before.points, this->bytes - before.bytes};
  }
};

} // namespace inr
