// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedMarcher.h"

#include "Core/Render/Blending/CachedCompositing.h"
#include "Core/Render/Blending/CachedIntegration.h"
#include "Core/Render/Blending/CachedProjection.h"
#include "Core/Render/Blending/CachedShading.h"
#include "Core/Render/Blending/CachedSurfaces.h"

#include <utility>

namespace inr {

namespace {

std::unique_ptr<CachedColors> ColorsOf(MarchedBatch& batch)
{
  if (batch.scene().settings.preIntegrated != nullptr) {
    return std::make_unique<CachedIntegration>(batch);
  }
  return std::make_unique<CachedCompositing>(batch);
}

std::unique_ptr<CachedBlending> BlendingOf(MarchedBatch& batch)
{
  const CachedScene& scene = batch.scene();
  if (scene.settings.projector.findsSurfaces()) {
    return std::make_unique<CachedSurfaces>(batch);
  }
  if (scene.shading != nullptr) {
    return std::make_unique<CachedShading>(batch, ColorsOf(batch));
  }
  if (scene.settings.projector.projects()) {
    return std::make_unique<CachedProjection>(batch);
  }
  return ColorsOf(batch);
}

} // namespace

CachedMarcher::CachedMarcher(const CachedScene& scene, OnMiss onMiss)
    : Batch(scene, onMiss), Blending(BlendingOf(this->Batch))
{}

FrameStatistics CachedMarcher::statistics()
{
  FrameStatistics statistics = this->Batch.statistics();
  statistics.work.gradients = this->Blending->gradients();
  return statistics;
}

CachedRay CachedMarcher::begin(int x, int y)
{
  const CachedScene& scene = this->Batch.scene();
  CachedRay ray(scene, x, y);
  bool meets = ray.ray.length > 0;
  if (scene.frame.layers && !meets) {
    meets = scene.geometry.ray(x, y).length > 0;
    ray.layered.part = meets ? 0 : scene.frame.layers->count();
  }
  this->Batch.statistics().rays += meets ? 1 : 0;
  return ray;
}

bool CachedMarcher::march(CachedRay& ray)
{
  if (!this->Batch.scene().frame.layers) {
    return this->marchPart(ray);
  }
  while (this->marchPart(ray)) {
    if (!ray.enterNextPart(this->Batch.scene())) {
      return true;
    }
  }
  return false;
}

bool CachedMarcher::marchPart(CachedRay& ray)
{
  SamplePlacer& placer = this->Batch.placer();
  placer.begin(ray);
  this->Blending->begin();
  while (!placer.ended() && !placer.waits()) {
    const double before = ray.color.transmittance;
    this->Blending->advance(ray);
    if (this->isDone(ray)) {
      placer.end();
    }
    placer.adaptRoom(before, ray.color.transmittance);
  }
  if (placer.ended()) {
    this->Blending->finish(ray);
  }
  placer.finish(ray);
  return placer.ended();
}

bool CachedMarcher::isDone(const CachedRay& ray) const
{
  return ray.color.transmittance <= OpaqueTransmittance ||
         this->Batch.scene().settings.projector.isFinal(ray.projection);
}

} // namespace inr
