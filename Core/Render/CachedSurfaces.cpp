// SPDX-License-Identifier: BSD-3-Clause
//
// What CachedMarcher does with the values of a batch where it looks for isosurfaces.
#include "Core/Render/CachedMarcher.h"
#include "Core/Render/SurfaceCrossings.h"

#include <algorithm>

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
  const int level = this->Placed.levelOf(sample);
  const float value = this->Batch.value[sample];
  if (interval >= 0 && // else it is of the ray's first, and nothing is in front of that
      !this->drawSurfaces(state, level, interval, origin.offset, value)) {
    return false;
  }
  state.known = {static_cast<double>(interval + origin.steps), level, value};
  return true;
}

bool CachedMarcher::drawSurfaces(CachedRay& state, int level, std::int64_t interval, double length,
                                 float last)
{
  const auto begin = static_cast<double>(interval);
  KnownValue& known = state.known;
  const auto look = [&](double place, float& value) {
    return this->Probe->find(state.ray, level, place, state.color.transmittance,
                             this->Notes.requests, value);
  };
  if (known.at < begin || known.level != level) {
    const double place = std::max(begin, known.at);
    float value = 0;
    if (!look(place, value)) {
      return false;
    }
    known = {place, level, value};
  }
  SurfaceInterval passed{known.at, begin + length, known.value, last};
  const bool done = DrawSurfaces(
      this->Scene.settings.projector.surfaces, passed, look, [&](float value, double place) {
        if (!this->drawSurface(state, value, level, place)) {
          return BehindSurface::Wait;
        }
        const bool isOpaque = state.color.transmittance <= OpaqueTransmittance;
        return isOpaque ? BehindSurface::End : BehindSurface::GoOn;
      });
  known = {passed.begin, level, passed.first}; // what is drawn is not to be drawn again
  return done;
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
