// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/MarchedBatch.h"

#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/RayMarching.h"

#include <cmath>
#include <limits>

namespace inr {

void MarchedBatch::fill(CachedRay& ray)
{
  this->Placer.place(ray);
  this->Scene.kernel.sampleRuns(this->Scene.format, this->samples(), this->placed().runs);
}

void MarchedBatch::goBackTo(int sample, const SampleWalker& before, CachedRay& ray)
{
  this->Notes.statistics.clamped -= CountBits(this->Clamped >> sample);
  this->Placer.goBackTo(sample, before, ray);
}

double MarchedBatch::timeOf(const CachedRay& ray, int sample) const
{
  return this->placed().timeOf(sample, this->Scene.settings.step, ray.ray.length);
}

double MarchedBatch::lengthOf(int sample) const
{
  return this->placed().lengthOf(sample,
                                 this->Scene.settings.step * this->Scene.settings.unitsPerT);
}

bool MarchedBatch::moveIntoRange(int sample)
{
  SampleBatch& batch = this->samples();
  float& value = batch.value[sample];
  const float found = value;
  ClampToRange({batch.low[sample], batch.high[sample]}, value);
  return std::abs(found - value) > RoundingOfStorage;
}

void MarchedBatch::clampToRange(int sample)
{
  this->Notes.statistics.clamped += this->moveIntoRange(sample) ? 1 : 0;
}

void MarchedBatch::clampToRanges()
{
  this->Clamped = 0;
  for (int k = 0; k < this->placed().count; ++k) {
    this->Clamped |= std::uint64_t{this->moveIntoRange(k)} << k;
  }
  this->Notes.statistics.clamped += CountBits(this->Clamped);
}

void MarchedBatch::takeLogarithms(int count)
{
  SampleBatch& batch = this->samples();
  for (int k = 0; k < count; ++k) {
    this->clampToRange(k);
    batch.value[k] = this->Scene.colors.coordinate(batch.value[k]);
    batch.low[k] = -std::numeric_limits<float>::max();
    batch.high[k] = std::numeric_limits<float>::max();
  }
}

void MarchedBatch::noteHalfOpaque(CachedRay& ray, int first, int end) const
{
  if (ray.halfOpaqueAt < 0 && ray.color.transmittance <= 0.5f) {
    int k = first; // the last sample whose light was not yet halved
    while (k + 1 < end && this->placed().batch.opacity[k + 1] < 0.5f) {
      ++k;
    }
    ray.halfOpaqueAt = this->timeOf(ray, k);
  }
}

} // namespace inr
