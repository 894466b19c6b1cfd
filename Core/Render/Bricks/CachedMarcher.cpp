// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/CachedMarcher.h"

#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/PreIntegratedColors.h"

namespace inr {

CachedMarcher::CachedMarcher(const CachedScene& scene, OnMiss onMiss)
    : Placer(scene, onMiss, this->Notes), Scene(scene), Missing(onMiss),
      Placed(this->Placer.placed()), Batch(this->Placer.batch())
{
  if (scene.settings.looksAtBothEnds()) {
    this->Probe.emplace(scene, onMiss);
  }
  if (scene.settings.preIntegrated != nullptr) {
    this->Integrals =
        scene.settings.preIntegrated->kernelLookup(scene.settings.step * scene.settings.unitsPerT);
  }
  if (scene.shading != nullptr && !scene.settings.projector.findsSurfaces()) {
    this->Shader.emplace(*scene.shading, BrickGradients(*scene.bricks, scene.format, scene.kernel),
                         scene.kernel);
  }
}

FrameStatistics CachedMarcher::statistics() const
{
  FrameStatistics statistics = this->Notes.statistics;
  statistics.work.gradients =
      (this->Shader ? this->Shader->gradients() : 0) + (this->Probe ? this->Probe->gradients() : 0);
  return statistics;
}

CachedRay CachedMarcher::begin(int x, int y)
{
  CachedRay ray(this->Scene, x, y);
  bool meets = ray.ray.length > 0;
  if (this->Scene.frame.layers && !meets) {
    meets = this->Scene.geometry.ray(x, y).length > 0;
    ray.layered.part = meets ? 0 : this->Scene.frame.layers->count();
  }
  this->Notes.statistics.rays += meets ? 1 : 0;
  return ray;
}

bool CachedMarcher::march(CachedRay& state)
{
  if (!this->Scene.frame.layers) {
    return this->marchPart(state);
  }
  while (this->marchPart(state)) {
    if (!state.enterNextPart(this->Scene)) {
      return true;
    }
  }
  return false;
}

bool CachedMarcher::marchPart(CachedRay& state)
{
  const bool projects = this->Scene.settings.projector.projects();
  this->Placer.begin(state);
  if (this->Probe) {
    this->Probe->leave();
  }
  while (!this->Placer.ended() && !this->Placer.waits()) {
    const double before = state.color.transmittance;
    if (this->Scene.settings.projector.findsSurfaces()) {
      this->advanceSurfaces(state);
    } else if (this->Shader) {
      this->advanceShaded(state);
    } else if (this->Scene.settings.preIntegrated != nullptr) {
      this->advanceIntegrated(state);
    } else {
      this->sample(state);
      projects ? this->project(state) : this->composite(state);
    }
    if (this->isDone(state)) {
      this->Placer.end();
    }
    this->Placer.adaptRoom(before, state.color.transmittance);
  }
  if (projects && this->Placer.ended()) {
    this->finishProjection(state);
  }
  this->Placer.finish(state);
  return this->Placer.ended();
}

void CachedMarcher::sample(CachedRay& state)
{
  this->Placer.place(state);
  this->Scene.kernel.sampleRuns(this->Scene.format, this->Batch, this->Placed.runs);
}

void CachedMarcher::goBackTo(int sample, const SampleWalker& before, CachedRay& state)
{
  this->Notes.statistics.clamped -= CountBits(this->Clamped >> sample);
  this->Placer.goBackTo(sample, before, state);
}

void CachedMarcher::advanceShaded(CachedRay& state)
{
  const SampleWalker before = state.samples; // bricks may be asked for that are not there
  const KnownValue knownBefore = state.known;
  this->sample(state);
  this->clampToRanges();
  const bool integrates = this->Scene.settings.preIntegrated != nullptr;
  glm::vec4 colors[SampleBatch::Capacity];
  float opacities[SampleBatch::Capacity];
  int known = integrates ? this->findIntegrated(state, colors, opacities)
                         : this->findOpacities(state, colors, opacities);
  known = this->shade(state, known, colors);
  for (int k = 0; k < known; ++k) {
    if (opacities[k] > 0.0f && this->addLight(state, colors[k], opacities[k])) {
      state.halfOpaqueAt = this->timeOf(state, k);
    }
  }
  if (integrates) { // no further than what is lit: it goes on from there
    state.known = known > 0 ? this->knownBehind(known - 1) : knownBefore;
  }
  if (known < this->Placed.count && state.color.transmittance > OpaqueTransmittance) {
    this->goBackTo(known, before, state);
  }
}

int CachedMarcher::shade(const CachedRay& state, int count, glm::vec4* colors)
{
  const bool isLitFromPlaces = this->Scene.shading->view().knowsPlaces();
  double t[SampleBatch::Capacity];
  for (int k = 0; isLitFromPlaces && k < count; ++k) {
    t[k] = this->timeOf(state, k);
  }
  const bool stops = this->Missing == OnMiss::Stop;
  const SampleShader::Request request{
      state.ray, stops ? BrickGradients::Missing::Stop : BrickGradients::Missing::OneSided,
      static_cast<float>(state.color.transmittance), this->Placed.bricks,
      isLitFromPlaces ? t : nullptr};
  const std::size_t asked = this->Notes.requests.entries().size();
  const int known = this->Shader->shade(this->Batch, count, request, this->Notes.requests, colors);
  if (!stops) {
    this->Notes.statistics.missed +=
        static_cast<std::int64_t>(this->Notes.requests.entries().size() - asked);
  }
  return known;
}

} // namespace inr
