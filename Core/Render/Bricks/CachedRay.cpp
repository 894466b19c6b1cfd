// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/CachedRay.h"

#include "Core/Render/Marching/RayMarching.h"
#include "Core/Render/Scene/Opacity.h"

namespace inr {

namespace {

/// Of a ray through pixel (x, y).
SampleWalker SamplesOf(const CachedScene& scene, const Ray& ray, std::uint64_t stream, int x, int y)
{
  SampleWalker samples(scene.majorants.view(), scene.settings, ray, scene.frame.levelOfDetailScale,
                       scene.bricks->cache().hierarchy().levels(),
                       JitterOf(scene.settings, stream));
  if (ray.length > 0) {
    samples.confine(scene.seen->of(ray, x, y), scene.settings);
  }
  return samples;
}

/// The first part of the ray through pixel (x, y); none where nothing is seen, unless that is
/// projected, too.
Ray FirstPart(const CachedScene& scene, int x, int y)
{
  const bool isMissed = scene.seen->isEmpty(x, y) && !scene.settings.projector.projects();
  return isMissed ? Ray() : scene.geometry.ray(x, y, 0);
}

} // namespace

CachedRay::CachedRay(const CachedScene& scene, int x, int y)
    : ray(FirstPart(scene, x, y)), stream(StreamsOf(scene.frame).at(x, y)),
      samples(SamplesOf(scene, this->ray, this->stream, x, y)), x(x), y(y)
{
  this->color.ofMany = this->samples.end() > ManySamples;
}

bool CachedRay::enterNextPart(const CachedScene& scene)
{
  const RayView& rays = scene.geometry.view();
  const double* const rgb = this->color.rgb;
  const auto transmittance = static_cast<float>(this->color.transmittance);
  if (!this->layered.enterNextPart(rays, rays.pixel(this->x, this->y), this->ray,
                                   glm::vec3(rgb[0], rgb[1], rgb[2]), transmittance,
                                   this->halfOpaqueAt)) {
    return false;
  }
  this->ray = rays.ray(this->x, this->y, this->layered.part);
  this->samples = SamplesOf(scene, this->ray, this->stream, this->x, this->y);
  this->color.ofMany = this->color.ofMany || this->samples.end() > ManySamples;
  this->known = {};
  this->shownTo = Unknown;
  return true;
}

bool CachedRay::addLight(const glm::vec4& added, float opacity)
{
  const double weight = this->color.transmittance * opacity;
  for (int channel = 0; channel < 3; ++channel) {
    this->color.rgb[channel] += weight * added[channel];
  }
  this->color.transmittance -= weight;
  return this->halfOpaqueAt < 0 && this->color.transmittance <= 0.5f;
}

void CachedRay::composite(const glm::vec4& added, float length, double t)
{
  if (this->addLight(added, OpacityOver(length, added.w))) {
    this->halfOpaqueAt = t;
  }
}

} // namespace inr
