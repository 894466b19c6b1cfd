// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/CachedMarcher.h"

#include "Core/Render/PreIntegratedColors.h"
#include "Core/Render/SampleBits.h"

#include <algorithm>

namespace inr {

namespace {

/// Samples that a ray's first batch is for.
constexpr int FirstRoom = 32;
/// And, at most, one of samples that are looked at one by one: of these there is a bit for each.
constexpr int MostSingle = 64;

/// Of a ray through pixel (x, y).
SampleWalker SamplesOf(const CachedScene& scene, const Ray& ray, std::uint64_t stream, int x, int y)
{
  SampleWalker samples(scene.majorants.view(), scene.settings, ray, scene.frame.levelOfDetailScale,
                       scene.bricks.cache().hierarchy().levels(), JitterOf(scene.settings, stream));
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

double ShortestBlockOf(const BrickFormat& format)
{
  const double edge = 1.0 / static_cast<double>(format.blocksPerVoxel);
  double shortest = edge;
  for (int axis = 0; axis < 3; ++axis) {
    if (format.lastCell[axis] >= 0) { // else the volume is one voxel thick
      shortest = std::min(shortest, format.lastCell[axis] + 1 - format.lastBlock[axis] * edge);
    }
  }
  return shortest;
}

} // namespace

CachedRay::CachedRay(const CachedScene& scene, int x, int y)
    : ray(FirstPart(scene, x, y)), stream(StreamsOf(scene.frame).at(x, y)),
      samples(SamplesOf(scene, this->ray, this->stream, x, y)), x(x), y(y)
{
  this->color.ofMany = this->samples.end() > ManySamples;
}

CachedMarcher::CachedMarcher(const CachedScene& scene, OnMiss onMiss)
    : Scene(scene), Missing(onMiss),
      DitherMask(scene.settings.projector.findsSurfaces() ? 0 : ~std::int64_t{0}),
      ShortestBlock(ShortestBlockOf(scene.format))
{
  if (scene.settings.looksAtBothEnds()) {
    this->Probe.emplace(scene, onMiss, this->Absent);
  }
  if (scene.settings.preIntegrated != nullptr) {
    this->Integrals =
        scene.settings.preIntegrated->kernelLookup(scene.settings.step * scene.settings.unitsPerT);
  }
  if (scene.shading != nullptr && !scene.settings.projector.findsSurfaces()) {
    this->Shader.emplace(*scene.shading, BrickGradients(scene.bricks, scene.format, scene.kernel));
  }
}

FrameStatistics CachedMarcher::statistics() const
{
  FrameStatistics statistics = this->Statistics;
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
    ray.part = meets ? 0 : this->Scene.frame.layers->count();
  }
  this->Statistics.rays += meets ? 1 : 0;
  return ray;
}

bool CachedMarcher::march(CachedRay& state)
{
  if (!this->Scene.frame.layers) {
    return this->marchPart(state);
  }
  while (this->marchPart(state)) {
    const glm::vec3 color(state.color.rgb[0], state.color.rgb[1], state.color.rgb[2]);
    state.light.gather(color, state.color.transmittance);
    if (!this->enterNextPart(state)) {
      return true;
    }
  }
  return false;
}

bool CachedMarcher::enterNextPart(CachedRay& state) const
{
  const TranslucentLayers& layers = *this->Scene.frame.layers;
  const auto pixel = static_cast<std::size_t>(state.y) * this->Scene.frame.width + state.x;
  if (layers.depth(state.part, pixel) >= 1.0f || state.color.transmittance <= OpaqueTransmittance) {
    return false;
  }
  state.light.pass(layers.color(state.part, pixel));
  if (state.light.passes() <= 0.0f) {
    return false;
  }
  if (state.halfOpaqueAt >= 0 && state.halfOpaqueDepth < 0) {
    state.halfOpaqueDepth = this->Scene.geometry.windowDepth(state.ray.at(state.halfOpaqueAt));
  }
  state.ray = this->Scene.geometry.ray(state.x, state.y, ++state.part);
  state.samples = SamplesOf(this->Scene, state.ray, state.stream, state.x, state.y);
  state.color.ofMany = state.color.ofMany || state.samples.end() > ManySamples;
  state.known = {};
  state.shownTo = CachedRay::Unknown;
  return true;
}

bool CachedMarcher::marchPart(CachedRay& state)
{
  const bool projects = this->Scene.settings.projector.projects();
  this->Visited = state.samples.visited();
  this->Ended = false;
  this->Waiting = false;
  this->Awaited.reset();
  this->Ways[0].forget();
  this->Ways[1].forget();
  if (this->Probe) {
    this->Probe->leave();
  }
  if (this->Scene.settings.crops) {
    this->Cropped.emplace(this->Scene.settings.cropping, state.ray, this->Scene.settings.step);
  }
  this->Room = FirstRoom;
  while (!this->Ended && !this->Waiting) {
    const double before = state.color.transmittance;
    if (this->Scene.settings.projector.findsSurfaces()) {
      this->advanceSurfaces(state);
    } else if (this->Shader) {
      this->advanceShaded(state);
    } else if (this->Scene.settings.preIntegrated != nullptr) {
      this->advanceIntegrated(state);
    } else {
      this->place(state);
      this->Scene.kernel.sampleRuns(this->Scene.format, this->Batch, this->RunCount);
      projects ? this->project(state) : this->composite(state);
    }
    this->Ended = this->Ended || this->isDone(state);
    this->adaptRoom(before, state.color.transmittance);
  }
  if (projects && this->Ended) {
    this->finishProjection(state);
  }
  this->close(this->Runs[0], state.color.transmittance);
  this->close(this->Runs[1], state.color.transmittance);
  if (this->Awaited && !this->Ended) { // what made a ray opaque needs nothing behind it
    this->Requests.add(*this->Awaited, 1.0f);
  }
  this->Statistics.work.cells += state.samples.visited() - this->Visited;
  return this->Ended;
}

const CachedMarcher::Origin& CachedMarcher::originOf(int sample) const
{
  int run = this->RunCount - 1;
  while (this->Origins[run].sample > sample) {
    --run;
  }
  return this->Origins[run];
}

std::int64_t CachedMarcher::intervalOf(const Origin& origin, int sample)
{
  return origin.interval + PlaceOfBit(origin.shown, sample - origin.sample) * origin.steps;
}

double CachedMarcher::timeOf(const CachedRay& state, int sample) const
{
  const Origin& origin = this->originOf(sample);
  const std::int64_t interval = intervalOf(origin, sample);
  const double t = (static_cast<double>(interval) + origin.offset) * this->Scene.settings.step;
  return std::min(t, state.ray.length);
}

void CachedMarcher::adaptRoom(double before, double after)
{
  constexpr double little = 0.1;
  if (after < 0.5 * before || after < little) {
    this->Room = FirstRoom;
  } else if (after < 1.0 && after > 0.75 * before) {
    this->Room = std::min(2 * this->Room, this->mayGoBack() ? MostSingle : SampleBatch::Capacity);
  }
}

void CachedMarcher::close(BrickRun& run, float transmittance)
{
  this->Statistics.samples += run.count();
  if (run.count() > 0) {
    this->Statistics.levels.add({run.servedLevel(), run.servedLevel()});
    this->LevelSum += std::int64_t{run.count()} * run.servedLevel();
  }
  if (run.count() > 0 && !run.exact()) {
    this->Statistics.missed += run.count();
    this->Requests.add(run.wish(), static_cast<float>(run.count()) * transmittance);
  }
  run.close();
}

void CachedMarcher::advanceShaded(CachedRay& state)
{
  const SampleWalker before = state.samples; // bricks may be asked for that are not there
  const KnownValue knownBefore = state.known;
  this->place(state);
  this->Scene.kernel.sampleRuns(this->Scene.format, this->Batch, this->RunCount);
  this->clampToRanges();
  const bool integrates = this->Scene.settings.preIntegrated != nullptr;
  glm::vec4 colors[SampleBatch::Capacity];
  float opacities[SampleBatch::Capacity];
  int known = integrates ? this->findIntegrated(state, colors, opacities)
                         : this->findOpacities(state, colors, opacities);
  double t[SampleBatch::Capacity];
  for (int k = 0; k < known; ++k) {
    t[k] = this->timeOf(state, k);
  }
  known = this->shade(state, known, t, colors);
  for (int k = 0; k < known; ++k) {
    if (opacities[k] > 0.0f) {
      this->addLight(state, colors[k], opacities[k], t[k]);
    }
  }
  if (integrates) { // no further than what is lit: it goes on from there
    state.known = known > 0 ? this->knownBehind(known - 1) : knownBefore;
  }
  if (known < this->Count && state.color.transmittance > OpaqueTransmittance) {
    this->goBackTo(known, before, state);
  }
}

int CachedMarcher::shade(const CachedRay& state, int count, const double* t, glm::vec4* colors)
{
  const bool stops = this->Missing == OnMiss::Stop;
  const SampleShader::Request request{
      state.ray, stops ? BrickGradients::Missing::Stop : BrickGradients::Missing::OneSided,
      static_cast<float>(state.color.transmittance), this->Bricks, t};
  const std::size_t asked = this->Requests.entries().size();
  const int known = this->Shader->shade(this->Batch, count, request, this->Requests, colors);
  if (!stops) {
    this->Statistics.missed += static_cast<std::int64_t>(this->Requests.entries().size() - asked);
  }
  return known;
}

void CachedMarcher::goBackTo(int sample, const SampleWalker& before, CachedRay& state)
{
  const Origin& origin = this->originOf(sample);
  this->Statistics.work.cells += state.samples.visited() - before.visited();
  state.samples = before;
  state.samples.resume(intervalOf(origin, sample), origin.stretch, this->Scene.settings);
  state.shownTo = intervalOf(origin, sample); // this one is wanted, whether it shows something
  this->Statistics.samples -= this->Count - sample; // they will be counted again
  this->Statistics.clamped -= CountBits(this->Clamped >> sample);
  const int taken = sample - origin.sample;
  this->Statistics.hidden = origin.hidden + PlaceOfBit(origin.shown, taken) - taken;
  for (int k = sample; k < this->Count; ++k) {
    this->LevelSum -= this->originOf(k).level;
  }
  this->Awaited.reset(); // it waits for something nearer
  this->Waiting = true;
  this->Ended = false;
}

} // namespace inr
