// SPDX-License-Identifier: BSD-3-Clause
//
// What CachedMarcher does with the values of a batch where samples have the colours of all values
// since the one before.
#include "Core/Render/Bricks/CachedMarcher.h"
#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/PreIntegratedColors.h"

#include <algorithm>

namespace inr {

namespace {

/// How many bits are set from the lowest one on, which is.
int CountInARow(std::uint64_t bits) { return ~bits == 0 ? 64 : __builtin_ctzll(~bits); }

} // namespace

void CachedMarcher::advanceIntegrated(CachedRay& state)
{
  const SampleWalker before = state.samples; // bricks may be asked for that are not there
  this->sample(state);
  this->clampToRanges();
  const int known = this->findBegins(state);
  this->compositeKnown(state, this->isInFront(0) ? 1 : 0, known);
  if (known < this->Placed.count && state.color.transmittance > OpaqueTransmittance) {
    this->goBackTo(known, before, state);
  }
}

bool CachedMarcher::isInFront(int sample) const
{
  return sample == 0 && this->Placed.count > 0 && this->Placed.origins[0].intervalOf(0) < 0;
}

int CachedMarcher::findBegins(CachedRay& state)
{
  for (int number = 0; number < this->Placed.runs; ++number) {
    const SampleOrigin& origin = this->Placed.origins[number];
    const int end = number + 1 < this->Placed.runs ? this->Placed.origins[number + 1].sample
                                                   : this->Placed.count;
    std::uint64_t rest = origin.shown;
    for (int k = origin.sample; k < end;) {
      const int place = __builtin_ctzll(rest);
      const int count = CountInARow(rest >> place);
      if (!this->findBegin(state, origin, place, k)) {
        return k;
      }
      std::copy_n(this->Batch.value + k, count - 1, this->Batch.begin + k + 1);
      k += count;
      rest &= ~(LowestBits(count) << place);
      state.known = {static_cast<double>(origin.interval + (place + count) * origin.steps),
                     this->Batch.value[k - 1]};
    }
  }
  return this->Placed.count;
}

bool CachedMarcher::findBegin(const CachedRay& state, const SampleOrigin& origin, int place,
                              int sample)
{
  const std::int64_t interval = origin.interval + place * origin.steps;
  float& begin = this->Batch.begin[sample];
  begin = this->Batch.value[sample];
  if (static_cast<double>(interval) == state.known.at) {
    begin = state.known.value;
    return true;
  }
  if (interval < 0 || (origin.seen >> place & 1) == 0) {
    return true; // of what is in front of the ray, or shows nothing, only the value counts
  }
  const std::size_t asked = this->Notes.requests.entries().size();
  const bool found =
      this->Probe->find(state.ray, this->Placed.levelOf(sample), static_cast<double>(interval),
                        static_cast<float>(state.color.transmittance), this->Notes.requests, begin);
  if (found && this->Notes.requests.entries().size() > asked) {
    ++this->Notes.statistics.missed; // from a coarser level
  }
  return found;
}

void CachedMarcher::compositeKnown(CachedRay& state, int first, int end)
{
  const bool isLast = this->Placed.lastLength > 0 && end == this->Placed.count;
  const int whole = isLast ? end - 1 : end; // apart, for its own length
  if (first < whole) {
    this->takeCoordinates(first, whole);
    const int used = this->Scene.kernel.compositeIntegrated(
        this->Integrals, this->Batch, first, whole, OpaqueTransmittance, state.color);
    this->noteHalfOpaque(state, first, first + used);
  }
  if (isLast && first < end && state.color.transmittance > OpaqueTransmittance) {
    const glm::vec4 color = this->Scene.settings.preIntegrated->between(this->Batch.begin[whole],
                                                                        this->Batch.value[whole]);
    this->compositeColor(state, color, this->Placed.lastLength, this->timeOf(state, whole));
  }
}

void CachedMarcher::takeCoordinates(int first, int end)
{
  if (this->Scene.colors.logarithmic) {
    const auto coordinate = [this](float value) { return this->Scene.colors.coordinate(value); };
    for (float* const values : {this->Batch.begin, this->Batch.value}) {
      std::transform(values + first, values + end, values + first, coordinate);
    }
  }
}

int CachedMarcher::findIntegrated(CachedRay& state, glm::vec4* colors, float* opacities)
{
  const int count = this->findBegins(state);
  double transmittance = state.color.transmittance;
  int k = 0;
  for (; k < count && transmittance > OpaqueTransmittance; ++k) {
    colors[k] = this->isInFront(k) ? glm::vec4(0.0f)
                                   : this->Scene.settings.preIntegrated->between(
                                         this->Batch.begin[k], this->Batch.value[k]);
    opacities[k] =
        colors[k].w > 0.0f ? OpacityOver(static_cast<float>(this->lengthOf(k)), colors[k].w) : 0.0f;
    transmittance -= transmittance * opacities[k];
  }
  return k;
}

KnownValue CachedMarcher::knownBehind(int sample) const
{
  const SampleOrigin& origin = this->Placed.originOf(sample);
  return {static_cast<double>(origin.intervalOf(sample) + origin.steps), this->Batch.value[sample]};
}

} // namespace inr
