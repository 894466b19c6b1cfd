// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedSurfaces.h"

#include "Core/Render/Marching/SurfaceCrossings.h"

namespace inr {

void CachedSurfaces::advance(CachedRay& ray)
{
  const SampleWalker before = ray.samples; // surfaces may ask for bricks that are not there
  this->Batch.fill(ray);
  this->Batch.clampToRanges();
  for (int k = 0; k < this->Batch.placed().count && ray.color.transmittance > OpaqueTransmittance;
       ++k) {
    if (!this->cross(ray, k)) {
      this->Batch.goBackTo(k, before, ray);
      return;
    }
  }
}

bool CachedSurfaces::cross(CachedRay& ray, int sample)
{
  const SampleOrigin& origin = this->Batch.placed().originOf(sample);
  const std::int64_t interval = origin.intervalOf(sample);
  const auto begin = static_cast<double>(interval);
  const int level = this->Batch.placed().levelOf(sample);
  const float value = this->Batch.samples().value[sample];
  const auto look = [&](double place, float& found) {
    return this->Probe.find(ray.ray, level, place, ray.color.transmittance, this->Batch.requests(),
                            found);
  };
  const auto draw = [&](float surface, double place) {
    if (!this->draw(ray, surface, level, place)) {
      return BehindSurface::Wait;
    }
    const bool isOpaque = ray.color.transmittance <= OpaqueTransmittance;
    return isOpaque ? BehindSurface::End : BehindSurface::GoOn;
  };
  if (interval >= 0 && // else it is of the ray's first, and nothing is in front of that
      !PassSurfaces(this->Scene.settings.projector.surfaces, level, begin, begin + origin.offset,
                    value, ray.known, look, draw)) {
    return false;
  }
  ray.known = {static_cast<double>(interval + origin.steps), value,
               static_cast<std::int16_t>(level)};
  return true;
}

bool CachedSurfaces::draw(CachedRay& ray, float value, int level, double place)
{
  const double t = place * this->Scene.settings.step;
  if (!ray.ray.isInPiece(t)) {
    return true; // that of another picture finds it, too, from the same samples
  }
  glm::vec4 color = this->Scene.colors.at(value);
  if (this->Scene.shading != nullptr) {
    float found = 0;
    glm::vec3 gradient(0.0f);
    if (!this->Probe.find(ray.ray, level, place, ray.color.transmittance, this->Batch.requests(),
                          found) ||
        !this->Probe.findGradient(ray.color.transmittance, this->Batch.requests(), gradient)) {
      return false;
    }
    const ShadingView& lighting = this->Scene.shading->view();
    const glm::vec3 lit =
        lighting.shade(glm::vec3(color), lighting.toEye(ray.ray), ray.ray.at(t), gradient);
    color = glm::vec4(lit, color.w);
  }
  ray.composite(color, 1.0f, t);
  return true;
}

} // namespace inr
