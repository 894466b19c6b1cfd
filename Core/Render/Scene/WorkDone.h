// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickWork.h"

#include <cstdint>

namespace inr {

/// What a call that renders had to do, whether its picture shows it or not: all the passes and
/// paths of the call and what rays did twice because they had to wait, too. A call that throws
/// reports nothing.
struct WorkDone
{
  /// Points at which the field was asked but for bricks: by rays and paths without a cache, six for
  /// each of their gradients included, by paths whose bricks the cache cannot hold, and by
  /// LevelChooser.
  std::int64_t networkSamples = 0;
  std::int64_t gradients = 0;   ///< of the field
  std::int64_t scatterings = 0; ///< of paths
  std::int64_t lightSteps = 0;  ///< looks at the field on the way from a scattering to a light
  /// Macro-cells that were looked at, blocks of empty ones that are left at one go as one.
  std::int64_t cells = 0;
  /// Bricks that came in during the call. Those that the loader infers behind the application are
  /// of the next call that begins after they are finished, whichever renderer's that shares them.
  BrickWork bricks;

  bool operator==(const WorkDone& other) const
  {
    return this->networkSamples == other.networkSamples && this->gradients == other.gradients &&
           this->scatterings == other.scatterings && this->lightSteps == other.lightSteps &&
           this->cells == other.cells && this->bricks == other.bricks;
  }
  void add(const WorkDone& other)
  {
    this->networkSamples += other.networkSamples;
    this->gradients += other.gradients;
    this->scatterings += other.scatterings;
    this->lightSteps += other.lightSteps;
    this->cells += other.cells;
    this->bricks.add(other.bricks);
  }
};

} // namespace inr
