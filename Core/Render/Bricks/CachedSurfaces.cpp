// SPDX-License-Identifier: BSD-3-Clause
//
// What CachedMarcher does with the values of a batch where it looks for isosurfaces.
#include "Core/Render/Bricks/CachedMarcher.h"
#include "Core/Render/Marching/SurfaceCrossings.h"

namespace inr {

void CachedMarcher::advanceSurfaces(CachedRay& state)
{
  const SampleWalker before = state.samples; // surfaces may ask for bricks that are not there
  this->sample(state);
  this->clampToRanges();
  for (int k = 0; k < this->Placed.count && state.color.transmittance > OpaqueTransmittance; ++k) {
    if (!this->crossSurfaces(state, k)) {
      this->goBackTo(k, before, state);
      return;
    }
  }
}

bool CachedMarcher::crossSurfaces(CachedRay& state, int sample)
{
  const SampleOrigin& origin = this->Placed.originOf(sample);
  const std::int64_t interval = origin.intervalOf(sample);
  const auto begin = static_cast<double>(interval);
  const int level = this->Placed.levelOf(sample);
  const float value = this->Batch.value[sample];
  const auto look = [&](double place, float& found) {
    return this->Probe->find(state.ray, level, place, state.color.transmittance,
                             this->Notes.requests, found);
  };
  const auto draw = [&](float surface, double place) {
    if (!this->drawSurface(state, surface, level, place)) {
      return BehindSurface::Wait;
    }
    const bool isOpaque = state.color.transmittance <= OpaqueTransmittance;
    return isOpaque ? BehindSurface::End : BehindSurface::GoOn;
  };
  if (interval >= 0 && // else it is of the ray's first, and nothing is in front of that
      !PassSurfaces(this->Scene.settings.projector.surfaces, level, begin, begin + origin.offset,
                    value, state.known, look, draw)) {
    return false;
  }
  state.known = {static_cast<double>(interval + origin.steps), value,
                 static_cast<std::int16_t>(level)};
  return true;
}

bool CachedMarcher::drawSurface(CachedRay& state, float value, int level, double place)
{
  const double t = place * this->Scene.settings.step;
  if (!state.ray.isInPiece(t)) {
    return true; // that of another picture finds it, too, from the same samples
  }
  glm::vec4 color = this->Scene.colors.at(value);
  if (this->Scene.shading != nullptr) {
    float found = 0;
    glm::vec3 gradient(0.0f);
    if (!this->Probe->find(state.ray, level, place, state.color.transmittance, this->Notes.requests,
                           found) ||
        !this->Probe->findGradient(state.color.transmittance, this->Notes.requests, gradient)) {
      return false;
    }
    const ShadingView& lighting = this->Scene.shading->view();
    const glm::vec3 lit =
        lighting.shade(glm::vec3(color), lighting.toEye(state.ray), state.ray.at(t), gradient);
    color = glm::vec4(lit, color.w);
  }
  this->compositeColor(state, color, 1.0f, t);
  return true;
}

} // namespace inr
