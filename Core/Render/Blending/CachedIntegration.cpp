// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedIntegration.h"

#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/PreIntegratedColors.h"
#include "Core/Render/Scene/Opacity.h"

#include <algorithm>

namespace inr {

namespace {

/// How many bits are set from the lowest one on, which is.
int CountInARow(std::uint64_t bits) { return ~bits == 0 ? 64 : __builtin_ctzll(~bits); }

} // namespace

CachedIntegration::CachedIntegration(MarchedBatch& batch)
    : Batch(batch), Scene(batch.scene()), Placed(batch.placed()), Samples(batch.samples()),
      Probe(batch.scene(), batch.missing()),
      Integrals(batch.scene().settings.preIntegrated->kernelLookup(
          batch.scene().settings.step * batch.scene().settings.unitsPerT))
{}

void CachedIntegration::advance(CachedRay& ray)
{
  const SampleWalker before = ray.samples; // bricks may be asked for that are not there
  this->Batch.fill(ray);
  this->Batch.clampToRanges();
  const int known = this->findBegins(ray);
  this->compositeKnown(ray, this->isInFront(0) ? 1 : 0, known);
  if (known < this->Placed.count && ray.color.transmittance > OpaqueTransmittance) {
    this->Batch.goBackTo(known, before, ray);
  }
}

bool CachedIntegration::isInFront(int sample) const
{
  return sample == 0 && this->Placed.count > 0 && this->Placed.origins[0].intervalOf(0) < 0;
}

int CachedIntegration::findBegins(CachedRay& ray)
{
  for (int number = 0; number < this->Placed.runs; ++number) {
    const SampleOrigin& origin = this->Placed.origins[number];
    const int end = number + 1 < this->Placed.runs ? this->Placed.origins[number + 1].sample
                                                   : this->Placed.count;
    std::uint64_t rest = origin.shown;
    for (int k = origin.sample; k < end;) {
      const int place = __builtin_ctzll(rest);
      const int count = CountInARow(rest >> place);
      if (!this->findBegin(ray, origin, place, k)) {
        return k;
      }
      std::copy_n(this->Samples.value + k, count - 1, this->Samples.begin + k + 1);
      k += count;
      rest &= ~(LowestBits(count) << place);
      ray.known = {static_cast<double>(origin.interval + (place + count) * origin.steps),
                   this->Samples.value[k - 1]};
    }
  }
  return this->Placed.count;
}

bool CachedIntegration::findBegin(const CachedRay& ray, const SampleOrigin& origin, int place,
                                  int sample)
{
  const std::int64_t interval = origin.interval + place * origin.steps;
  float& begin = this->Samples.begin[sample];
  begin = this->Samples.value[sample];
  if (static_cast<double>(interval) == ray.known.at) {
    begin = ray.known.value;
    return true;
  }
  if (interval < 0 || (origin.seen >> place & 1) == 0) {
    return true; // of what is in front of the ray, or shows nothing, only the value counts
  }
  const std::size_t asked = this->Batch.requests().entries().size();
  const bool found =
      this->Probe.find(ray.ray, this->Placed.levelOf(sample), static_cast<double>(interval),
                       static_cast<float>(ray.color.transmittance), this->Batch.requests(), begin);
  if (found && this->Batch.requests().entries().size() > asked) {
    ++this->Batch.statistics().missed; // from a coarser level
  }
  return found;
}

void CachedIntegration::compositeKnown(CachedRay& ray, int first, int end)
{
  const bool isLast = this->Placed.lastLength > 0 && end == this->Placed.count;
  const int whole = isLast ? end - 1 : end; // apart, for its own length
  if (first < whole) {
    this->takeCoordinates(first, whole);
    const int used = this->Scene.kernel.compositeIntegrated(this->Integrals, this->Samples, first,
                                                            whole, OpaqueTransmittance, ray.color);
    this->Batch.noteHalfOpaque(ray, first, first + used);
  }
  if (isLast && first < end && ray.color.transmittance > OpaqueTransmittance) {
    const glm::vec4 color = this->Scene.settings.preIntegrated->between(this->Samples.begin[whole],
                                                                        this->Samples.value[whole]);
    ray.composite(color, this->Placed.lastLength, this->Batch.timeOf(ray, whole));
  }
}

void CachedIntegration::takeCoordinates(int first, int end)
{
  if (this->Scene.colors.logarithmic) {
    const auto coordinate = [this](float value) { return this->Scene.colors.coordinate(value); };
    for (float* const values : {this->Samples.begin, this->Samples.value}) {
      std::transform(values + first, values + end, values + first, coordinate);
    }
  }
}

int CachedIntegration::find(CachedRay& ray, glm::vec4* colors, float* opacities)
{
  const int count = this->findBegins(ray);
  double transmittance = ray.color.transmittance;
  int k = 0;
  for (; k < count && transmittance > OpaqueTransmittance; ++k) {
    colors[k] = this->isInFront(k) ? glm::vec4(0.0f)
                                   : this->Scene.settings.preIntegrated->between(
                                         this->Samples.begin[k], this->Samples.value[k]);
    opacities[k] = colors[k].w > 0.0f
                       ? OpacityOver(static_cast<float>(this->Batch.lengthOf(k)), colors[k].w)
                       : 0.0f;
    transmittance -= transmittance * opacities[k];
  }
  return k;
}

void CachedIntegration::goOnBehind(int count, const KnownValue& before, CachedRay& ray) const
{
  if (count == 0) {
    ray.known = before;
    return;
  }
  const SampleOrigin& origin = this->Placed.originOf(count - 1);
  ray.known = {static_cast<double>(origin.intervalOf(count - 1) + origin.steps),
               this->Samples.value[count - 1]};
}

} // namespace inr
