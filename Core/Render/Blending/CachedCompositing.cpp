// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedCompositing.h"

#include "Core/Render/Scene/Opacity.h"

namespace inr {

void CachedCompositing::advance(CachedRay& ray)
{
  this->Batch.fill(ray);
  this->composite(ray);
  if (this->Batch.placed().lastLength > 0 && ray.color.transmittance > OpaqueTransmittance) {
    this->compositeLast(ray);
  }
}

void CachedCompositing::composite(CachedRay& ray)
{
  const int whole = this->Batch.whole();
  if (this->Scene.colors.logarithmic) {
    this->Batch.takeLogarithms(whole);
  }
  const int used = this->Scene.kernel.composite(this->Scene.steps->lookup(), this->Batch.samples(),
                                                whole, OpaqueTransmittance, ray.color,
                                                this->Batch.statistics().clamped);
  this->Batch.noteHalfOpaque(ray, 0, used);
}

void CachedCompositing::compositeLast(CachedRay& ray)
{
  const int last = this->Batch.placed().count - 1;
  this->Batch.clampToRange(last);
  ray.composite(this->Scene.colors.at(this->Batch.samples().value[last]),
                this->Batch.placed().lastLength, this->Batch.timeOf(ray, last));
}

int CachedCompositing::find(CachedRay& ray, glm::vec4* colors, float* opacities)
{
  const int count = this->Batch.placed().count;
  const int whole = this->Batch.whole();
  SampleBatch& samples = this->Batch.samples();
  if (this->Scene.colors.logarithmic) {
    this->Batch.takeLogarithms(whole);
  }
  this->Scene.kernel.findColors(this->Scene.steps->lookup(), samples, whole, &colors->x);
  if (whole < count) { // of a length of its own
    colors[whole] = this->Scene.colors.at(samples.value[whole]);
    colors[whole].w = OpacityOver(static_cast<float>(this->Batch.lengthOf(whole)), colors[whole].w);
  }
  double transmittance = ray.color.transmittance;
  int k = 0;
  for (; k < count && transmittance > OpaqueTransmittance; ++k) {
    opacities[k] = colors[k].w;
    transmittance -= transmittance * opacities[k];
  }
  return k;
}

} // namespace inr
