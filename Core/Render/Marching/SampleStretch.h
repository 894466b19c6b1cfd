// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MacroCells/CellBlock.h"

#include <cstdint>

namespace inr {

/// Samples of a ray that differ in nothing but their place: sample k stands for `steps()` steps,
/// from interval k * steps() after the first one's on.
struct AlikeSamples
{
  int count;
  int joined; ///< 1 to 4: samples of the level, 2^power steps apart, that each is taken for
  int power;
  bool last; ///< a single one, which the ray's end cuts short

  INR_HOST_DEVICE std::int64_t steps() const { return std::int64_t{this->joined} << this->power; }
};

/// A stretch of a ray whose samples are as far apart and as much joined as each other's: through
/// macro-cells that can be seen.
struct SampleStretch
{
  double exit = -1;     ///< samples at this place or behind it do not belong to it
  double levelEnd = -1; ///< nor do those whose steps begin here or later
  int power = 0;        ///< there are 2^power steps between samples
  int faint = 0;        ///< 2^faint of them may be taken at once
  ValueRange range;     ///< of the cells
  double reach = -1;    ///< where cells end that matter; see MarchSettings::looksAtBothEnds
  bool closed = false;  ///< samples belong to it only with all of their steps, or are of one step
  int level = 0;        ///< of a closed one, that samples come from
};

/// Samples that are looked ahead for when one is found: up to the end of a block of so many.
constexpr double SamplesAhead = 128;

/// Where a stretch begins, in steps.
struct StretchStart
{
  double begin;      ///< of what its first sample stands for
  double firstPlace; ///< that sample's
  double rayEnd;
  double reach; ///< of the stretch before
};

} // namespace inr
