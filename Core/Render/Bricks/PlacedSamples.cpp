// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/PlacedSamples.h"

#include "Core/Render/Marching/StepTable.h"

#include <algorithm>

namespace inr {

const SampleOrigin& PlacedSamples::originOf(int sample) const
{
  int run = this->runs - 1;
  while (this->origins[run].sample > sample) {
    --run;
  }
  return this->origins[run];
}

double PlacedSamples::timeOf(int sample, double step, double end) const
{
  const SampleOrigin& origin = this->originOf(sample);
  const double t = (static_cast<double>(origin.intervalOf(sample)) + origin.offset) * step;
  return std::min(t, end);
}

double PlacedSamples::lengthOf(int sample, double stepLength) const
{
  if (this->lastLength > 0 && sample + 1 == this->count) {
    return static_cast<double>(this->lastLength);
  }
  return stepLength * static_cast<double>(StepsOf(this->batch.length[sample]));
}

} // namespace inr
