// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/WorkDone.h"

#include <algorithm>
#include <cstdint>

namespace inr {

/// Levels of resolution from the finest to the coarsest that was met; 0 is the full resolution.
struct LevelSpan
{
  int finest = 64;
  int coarsest = -1;

  bool empty() const { return this->coarsest < this->finest; }
  void add(const LevelSpan& other)
  {
    this->finest = std::min(this->finest, other.finest);
    this->coarsest = std::max(this->coarsest, other.coarsest);
  }
};

/// What making a picture took; of path tracing, one path through each pixel, the latest, but for
/// the wall time and the work.
struct FrameStatistics
{
  std::int64_t rays = 0;    ///< that met the volume; the CPU leaves out some that show nothing
  std::int64_t samples = 0; ///< values of the field that were looked up or inferred
  std::int64_t missed = 0;  ///< of these, read from a coarser level than wanted
  std::int64_t hidden = 0;  ///< samples besides, left out as the voxels around them show nothing
  std::int64_t clamped = 0; ///< samples outside their macro-cell's range, moved to its nearer end
  /// All samples that may show something were taken, and each came from the level it asked for or,
  /// if the options are to make do with that, the best that a full cache has.
  bool complete = true;
  std::int64_t paths = 0; ///< of path tracing: through each pixel, in the picture shown
  /// Through the CPU's cache: there was no time yet for some pixels, which show nothing.
  bool blank = false;
  LevelSpan levels; ///< of the cache, that samples came from
  /// Whether an accelerator has drawn it, or part of it; else the CPU did, of what that inferred.
  bool accelerated = false;
  double seconds = 0; ///< wall time
  /// Wall time of the rays or paths, without what was loaded into the cache in between. Where only
  /// some tiles of a picture were marched or traced, the time that all of them took at first or,
  /// where some were not reached, may take.
  double marchSeconds = 0;
  WorkDone work; ///< of the call

  /// Which part of the samples is not missed, those that are left out included; 1 of none. A lit
  /// sample that lacks neighbours is missed for each.
  double hitRate() const
  {
    const std::int64_t all = this->samples + this->hidden;
    const auto missing = static_cast<double>(std::min(this->missed, all));
    return all > 0 ? 1.0 - missing / static_cast<double>(all) : 1.0;
  }

  /// Adds what was counted in another part of the picture; times are not counts.
  void add(const FrameStatistics& part)
  {
    this->rays += part.rays;
    this->samples += part.samples;
    this->missed += part.missed;
    this->hidden += part.hidden;
    this->clamped += part.clamped;
    this->levels.add(part.levels);
    this->accelerated = this->accelerated || part.accelerated;
    this->work.add(part.work);
  }
};

} // namespace inr
