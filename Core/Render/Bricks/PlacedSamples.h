// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickKey.h"
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/SampleStretch.h"

#include <cstdint>

namespace inr {

/// How the samples of a run came about, should the ray have to go back to one.
struct SampleOrigin
{
  int sample;            ///< the first one, in the batch
  double offset;         ///< from a sample's interval to its place
  std::int64_t interval; ///< at which the first one begins
  std::int64_t steps;    ///< that each stands for
  std::uint64_t shown;   ///< see SampleRun
  std::uint64_t seen;    ///< of these bits, of samples that may add to the picture
  std::int64_t hidden;   ///< samples left out before
  SampleStretch stretch; ///< where the ray may go back
  float level;           ///< that they came from, on average

  /// The interval of the ray's lattice at which a sample of the batch, one of these, begins.
  std::int64_t intervalOf(int number) const
  {
    return this->interval + PlaceOfBit(this->shown, number - this->sample) * this->steps;
  }
};

/// The next samples of a ray, in bricks, and where they come from; see SamplePlacer.
struct PlacedSamples
{
  SampleBatch batch{};
  SampleOrigin origins[SampleBatch::Capacity];    ///< of the batch's runs
  BrickKey bricks[2 * SampleBatch::Capacity + 2]; ///< of the batch's paths
  int count = 0;
  int runs = 0;
  int paths = 0;
  /// Opacity unit distances of the ray's last sample, if it is shorter than a step; else 0.
  float lastLength = 0;

  /// Until samples are added.
  void clear()
  {
    this->count = this->runs = this->paths = 0;
    this->lastLength = 0;
  }
  const SampleOrigin& originOf(int sample) const;
  /// Of the brick that a sample is read from.
  int levelOf(int sample) const { return IdOf(this->bricks[this->batch.path[sample]]).level; }
  /// t of a sample on its ray, which ends at `end`; `step` is the t between places.
  double timeOf(int sample, double step, double end) const;
  /// Opacity unit distances that a sample stands for; `stepLength`: those of a step.
  double lengthOf(int sample, double stepLength) const;
};

} // namespace inr
