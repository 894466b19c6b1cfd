// SPDX-License-Identifier: BSD-3-Clause
//
// What CachedMarcher does with the values of a batch.
#include "Core/Render/Bricks/CachedMarcher.h"
#include "Core/Render/Bricks/SampleBits.h"

#include <cmath>
#include <limits>

namespace inr {

bool CachedMarcher::moveIntoRange(int sample)
{
  float& value = this->Batch.value[sample];
  const float found = value;
  ClampToRange({this->Batch.low[sample], this->Batch.high[sample]}, value);
  return std::abs(found - value) > RoundingOfStorage;
}

void CachedMarcher::takeLogarithms(int count)
{
  for (int k = 0; k < count; ++k) {
    this->Notes.statistics.clamped += this->moveIntoRange(k) ? 1 : 0;
    this->Batch.value[k] = this->Scene.colors.coordinate(this->Batch.value[k]);
    this->Batch.low[k] = -std::numeric_limits<float>::max();
    this->Batch.high[k] = std::numeric_limits<float>::max();
  }
}

void CachedMarcher::composite(CachedRay& state)
{
  const bool isLast = this->Placed.lastLength > 0;
  const int whole = this->Placed.count - (isLast ? 1 : 0); // that one apart, for its own length
  if (this->Scene.colors.logarithmic) {
    this->takeLogarithms(whole);
  }
  const int used = this->Scene.kernel.composite(this->Scene.steps->lookup(), this->Batch, whole,
                                                OpaqueTransmittance, state.color,
                                                this->Notes.statistics.clamped);
  this->noteHalfOpaque(state, 0, used);
  if (isLast && state.color.transmittance > OpaqueTransmittance) {
    this->compositeLast(state);
  }
}

void CachedMarcher::noteHalfOpaque(CachedRay& state, int first, int end) const
{
  if (state.halfOpaqueAt < 0 && state.color.transmittance <= 0.5f) {
    int k = first; // the last sample whose light was not yet halved
    while (k + 1 < end && this->Batch.opacity[k + 1] < 0.5f) {
      ++k;
    }
    state.halfOpaqueAt = this->timeOf(state, k);
  }
}

void CachedMarcher::compositeLast(CachedRay& state)
{
  const int last = this->Placed.count - 1;
  this->Notes.statistics.clamped += this->moveIntoRange(last) ? 1 : 0;
  this->compositeColor(state, this->Scene.colors.at(this->Batch.value[last]),
                       this->Placed.lastLength, this->timeOf(state, last));
}

void CachedMarcher::compositeColor(CachedRay& state, const glm::vec4& color, float length, double t)
{
  if (this->addLight(state, color, OpacityOver(length, color.w))) {
    state.halfOpaqueAt = t;
  }
}

bool CachedMarcher::addLight(CachedRay& state, const glm::vec4& color, float opacity)
{
  const double weight = state.color.transmittance * opacity;
  for (int channel = 0; channel < 3; ++channel) {
    state.color.rgb[channel] += weight * color[channel];
  }
  state.color.transmittance -= weight;
  return state.halfOpaqueAt < 0 && state.color.transmittance <= 0.5f;
}

void CachedMarcher::clampToRanges()
{
  this->Clamped = 0;
  for (int k = 0; k < this->Placed.count; ++k) {
    this->Clamped |= std::uint64_t{this->moveIntoRange(k)} << k;
  }
  this->Notes.statistics.clamped += CountBits(this->Clamped);
}

double CachedMarcher::timeOf(const CachedRay& state, int sample) const
{
  return this->Placed.timeOf(sample, this->Scene.settings.step, state.ray.length);
}

double CachedMarcher::lengthOf(int sample) const
{
  return this->Placed.lengthOf(sample, this->Scene.settings.step * this->Scene.settings.unitsPerT);
}

int CachedMarcher::findOpacities(const CachedRay& state, glm::vec4* colors, float* opacities)
{
  const bool isLast = this->Placed.lastLength > 0;
  const int whole = this->Placed.count - (isLast ? 1 : 0);
  if (this->Scene.colors.logarithmic) {
    this->takeLogarithms(whole);
  }
  this->Scene.kernel.findColors(this->Scene.steps->lookup(), this->Batch, whole, &colors->x);
  if (isLast) { // of a length of its own
    colors[whole] = this->Scene.colors.at(this->Batch.value[whole]);
    colors[whole].w = OpacityOver(static_cast<float>(this->lengthOf(whole)), colors[whole].w);
  }
  double transmittance = state.color.transmittance;
  int k = 0;
  for (; k < this->Placed.count && transmittance > OpaqueTransmittance; ++k) {
    opacities[k] = colors[k].w;
    transmittance -= transmittance * opacities[k];
  }
  return k;
}

} // namespace inr
