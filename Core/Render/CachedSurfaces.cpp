// SPDX-License-Identifier: BSD-3-Clause
//
// What CachedMarcher does with the values of a batch where it looks for isosurfaces.
#include "Core/Render/CachedMarcher.h"

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
  SurfaceInterval passed{level, begin, begin + origin.offset, state.known.value,
                         this->Batch.value[sample]};
  const bool isFirst = interval < 0; // of the ray: nothing is in front of it
  const bool isKnown = state.known.at == interval && state.known.level == level;
  if (!isFirst && !isKnown &&
      !this->Probe->find(state.ray, level, begin, state.color.transmittance, this->Notes.requests,
                         passed.first)) {
    return false;
  }
  if (!isFirst && !this->drawSurfaces(state, passed)) {
    return false;
  }
  state.known = {interval + origin.steps, level, passed.last};
  return true;
}

bool CachedMarcher::drawSurfaces(CachedRay& state, const SurfaceInterval& interval)
{
  const SurfaceLookup& surfaces = this->Scene.settings.projector.surfaces;
  const int first = surfaces.below(interval.first);
  const int last = surfaces.below(interval.last);
  const CachedRay before = state;
  SurfaceInterval rest = interval;
  for (int at = first; at != last; at += first < last ? 1 : -1) {
    const int surface = first < last ? at : at - 1;
    if (state.color.transmittance <= OpaqueTransmittance) {
      break;
    }
    double place = 0;
    if (!this->findSurface(state, rest, surfaces.values[surface], place) ||
        !this->drawSurface(state, surface, interval.level, place)) {
      state = before;
      return false;
    }
    rest.begin = place; // the next one is behind it
  }
  return true;
}

bool CachedMarcher::findSurface(const CachedRay& state, const SurfaceInterval& interval,
                                float value, double& place)
{
  const bool rises = interval.first < interval.last;
  double low = interval.begin;
  double high = interval.end;
  for (int k = 0; k < Bisections; ++k) {
    const double middle = 0.5 * (low + high);
    float found = 0;
    if (!this->Probe->find(state.ray, interval.level, middle, state.color.transmittance,
                           this->Notes.requests, found)) {
      return false;
    }
    ((found >= value) == rises ? high : low) = middle;
  }
  place = 0.5 * (low + high);
  return true;
}

bool CachedMarcher::drawSurface(CachedRay& state, int surface, int level, double place)
{
  const float value = this->Scene.settings.projector.surfaces.values[surface];
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
