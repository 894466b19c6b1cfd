// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/CachedMarcher.h"

#include "Core/Render/StepTable.h"

#include <algorithm>

namespace inr {

namespace {

SampleWalker SamplesOf(const CachedScene& scene, const Ray& ray, std::uint64_t stream)
{
  return {scene.majorants,
          scene.settings,
          ray,
          scene.frame.levelOfDetailScale,
          scene.cache.hierarchy().levels(),
          JitterOf(scene.settings, stream)};
}

} // namespace

CachedRay::CachedRay(const CachedScene& scene, int x, int y)
    : ray(scene.geometry.ray(x, y, 0)), stream(PixelStream(scene.frame, x, y)),
      samples(SamplesOf(scene, this->ray, this->stream)), x(x), y(y)
{
  this->color.ofMany = this->samples.end() > ManySamples;
}

CachedMarcher::CachedMarcher(const CachedScene& scene, OnMiss onMiss)
    : Scene(scene), Missing(onMiss),
      DitherMask(scene.settings.projector.findsSurfaces() ? 0 : ~std::int64_t{0})
{
  if (scene.settings.projector.findsSurfaces()) {
    this->Probe.emplace(scene, onMiss);
  } else if (scene.shading != nullptr) {
    this->Shader.emplace(*scene.shading, BrickGradients(scene.cache, scene.format, scene.kernel));
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
  state.samples = SamplesOf(this->Scene, state.ray, state.stream);
  state.color.ofMany = state.color.ofMany || state.samples.end() > ManySamples;
  state.known = {};
  return true;
}

bool CachedMarcher::marchPart(CachedRay& state)
{
  const bool projects = this->Scene.settings.projector.projects();
  this->Visited = state.samples.visited();
  this->Ended = false;
  this->Waiting = false;
  this->Awaited.reset();
  this->Ways[0] = this->Ways[1] = {};
  if (this->Probe) {
    this->Probe->leave();
  }
  if (this->Scene.settings.crops) {
    this->Cropped.emplace(this->Scene.settings.cropping, state.ray, this->Scene.settings.step);
  }
  while (!this->Ended && !this->Waiting) {
    if (this->Probe) {
      this->advanceSurfaces(state);
    } else if (this->Shader) {
      this->advanceShaded(state);
    } else {
      this->place(state);
      this->Scene.kernel.sampleRuns(this->Scene.format, this->Batch, this->RunCount);
      projects ? this->project(state) : this->composite(state);
    }
    this->Ended = this->Ended || this->isDone(state);
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

void CachedMarcher::place(CachedRay& state)
{
  this->Count = 0;
  this->RunCount = 0;
  this->Paths = 0;
  this->LastLength = 0;
  for (BrickRun& run : this->Runs) {
    if (run.level() >= 0) {
      this->enlist(run);
    }
  }
  const MarchSettings& settings = this->Scene.settings;
  while (this->Count < SampleBatch::Capacity && !this->Ended && !this->Waiting) {
    if (!state.samples.moveToVisible(settings)) {
      this->Ended = true;
      return;
    }
    AlikeSamples alike = state.samples.alike();
    if (settings.projector.canSkip(state.projection, state.samples.stretch().range) ||
        (this->Cropped && this->isCropped(state, alike))) {
      state.samples.pass(alike, alike.count);
      continue;
    }
    const int count = this->add(state, alike);
    if (alike.last && count > 0) {
      this->LastLength =
          static_cast<float>(state.samples.rest() * settings.step * settings.unitsPerT);
      this->Ended = true;
    }
    state.samples.pass(alike, count);
  }
}

bool CachedMarcher::isCropped(const CachedRay& state, AlikeSamples& alike) const
{
  const double place = static_cast<double>(state.samples.next()) + state.samples.offset(alike);
  const double end = this->Cropped->end(place);
  alike.count = CountBelow((end - place) / static_cast<double>(alike.steps()), alike.count);
  return !this->Cropped->shows(place);
}

// Inline: called once per run of samples, and there are as many of them as of bricks.
inline void CachedMarcher::addRun(const CachedRay& state, const AlikeSamples& alike, int count,
                                  const BrickRun& fine, const BrickRun& coarse)
{
  const SampleWalker& samples = state.samples;
  const SampleStretch& stretch = samples.stretch();
  // A coarser brick than the one wanted may hold anything.
  const bool exact = fine.exact() && coarse.exact();
  const ValueRange range = exact ? stretch.range : ValueRange{0.0f, 1.0f};
  const double offset = samples.offset(alike);
  const auto begin = static_cast<double>(samples.next());
  const double growth = samples.detail().fractionGrowth() * this->Scene.settings.step;
  const double fraction = samples.detail().fractionAtEntry() + growth * fine.reference();
  SampleRun& run = this->Batch.runs[this->RunCount];
  run.start[0] = fine.along(begin);
  run.start[1] = coarse.along(begin);
  run.spacing = static_cast<float>(alike.steps());
  run.offset = static_cast<float>(offset);
  run.ways = samples.detail().isDithered() ? 2 : 1;
  run.path[0] = fine.place();
  run.path[1] = coarse.place();
  run.fraction = static_cast<float>(fraction);
  run.growth = static_cast<float>(growth);
  run.seed = DitherSeed(state.stream);
  run.counter = static_cast<std::uint32_t>(this->ditherOf(samples.next()));
  run.stride = static_cast<std::uint32_t>(this->ditherOf(alike.steps()));
  run.count = count;
  run.length = LengthOf(alike.joined, alike.power);
  run.low = range.low;
  run.high = range.high;
  this->Origins[this->RunCount++] = {this->Count,   offset,  samples.next(),
                                     alike.steps(), stretch, fine.servedLevel()};
  this->Count += count;
}

inline void CachedMarcher::countUse(const CachedRay& state, const AlikeSamples& alike, int count,
                                    BrickRun& fine, BrickRun& coarse) const
{
  if (fine.exact() && coarse.exact()) { // nobody asks which it was
    fine.count(count);
    return;
  }
  const LevelOfDetail& detail = state.samples.detail();
  for (int k = 0; k < count; ++k) {
    const std::int64_t interval = state.samples.next() + k * alike.steps();
    const bool isFine = detail.dithered(state.stream, this->ditherOf(interval)) == fine.level();
    (isFine ? fine : coarse).count(1);
  }
}

int CachedMarcher::add(const CachedRay& state, const AlikeSamples& alike)
{
  const LevelOfDetail& detail = state.samples.detail();
  const double place = static_cast<double>(state.samples.next()) + state.samples.offset(alike);
  BrickRun* fine = this->runFor(state, detail.level(), place);
  BrickRun* coarse = detail.isDithered() ? this->runFor(state, detail.level() + 1, place) : fine;
  if (fine == nullptr || coarse == nullptr) {
    this->Waiting = true;
    return 0;
  }
  int count = std::min(alike.count, SampleBatch::Capacity - this->Count);
  if (count > 1) {
    const double room = std::min(fine->exit(), coarse->exit()) - place;
    count = CountBelow(room / static_cast<double>(alike.steps()), count);
  }
  this->addRun(state, alike, count, *fine, *coarse);
  this->countUse(state, alike, count, *fine, *coarse);
  return count;
}

const CachedMarcher::Origin& CachedMarcher::originOf(int sample) const
{
  int run = this->RunCount - 1;
  while (this->Origins[run].sample > sample) {
    --run;
  }
  return this->Origins[run];
}

double CachedMarcher::timeOf(const CachedRay& state, int sample) const
{
  const Origin& origin = this->originOf(sample);
  const std::int64_t interval = origin.interval + (sample - origin.sample) * origin.steps;
  const double t = (static_cast<double>(interval) + origin.offset) * this->Scene.settings.step;
  return std::min(t, state.ray.length);
}

BrickRun* CachedMarcher::runFor(const CachedRay& state, int level, double place)
{
  BrickRun& run = this->Runs[level & 1];
  if (run.covers(level, place)) {
    return &run;
  }
  this->close(run, state.color.transmittance);
  return this->open(run, state.ray, level, place) ? &run : nullptr;
}

bool CachedMarcher::open(BrickRun& run, const Ray& ray, int level, double place)
{
  const BrickCache& cache = this->Scene.cache;
  const Hierarchy& hierarchy = cache.hierarchy();
  const double t = place * this->Scene.settings.step;
  BrickWay& wanted = this->Ways[level & 1];
  if (wanted.level() != level) {
    wanted = BrickWay(hierarchy, level, ray);
  }
  wanted.moveTo(t);
  const BrickKey key = wanted.brick();
  std::int32_t slot = cache.find(key);
  if (slot >= 0) {
    run.open(wanted, wanted, cache.view(slot), this->Scene.settings.step);
  } else if (this->Missing == OnMiss::Stop) {
    this->Awaited = key;
    return false;
  } else {
    slot = this->openCoarser(run, ray, wanted, t);
  }
  cache.touch(slot);
  this->enlist(run);
  return true;
}

std::int32_t CachedMarcher::openCoarser(BrickRun& run, const Ray& ray, const BrickWay& wanted,
                                        double t)
{
  const BrickCache& cache = this->Scene.cache;
  const Hierarchy& hierarchy = cache.hierarchy();
  BrickKey wish = wanted.brick();
  for (int level = wanted.level() + 1;; ++level) { // the coarsest is there
    BrickWay served(hierarchy, level, ray);
    served.moveTo(t);
    const std::int32_t slot = cache.find(served.brick());
    if (slot >= 0) {
      run.open(wanted, served, cache.view(slot), this->Scene.settings.step);
      if (this->Missing == OnMiss::Approach) {
        run.wishFor(wish);
      }
      return slot;
    }
    wish = served.brick();
  }
}

void CachedMarcher::enlist(BrickRun& run)
{
  run.setPlace(this->Paths);
  this->Bricks[this->Paths] = run.served();
  this->Batch.paths[this->Paths++] = run.path();
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
  const CachedRay before = state; // gradients may ask for bricks that are not there
  this->place(state);
  this->Scene.kernel.sampleRuns(this->Scene.format, this->Batch, this->RunCount);
  this->clampToRanges();
  glm::vec4 colors[SampleBatch::Capacity];
  float opacities[SampleBatch::Capacity];
  const int needed = this->findOpacities(state, colors, opacities);
  double t[SampleBatch::Capacity];
  for (int k = 0; k < needed; ++k) {
    t[k] = this->timeOf(state, k);
  }
  const bool stops = this->Missing == OnMiss::Stop;
  const SampleShader::Request request{
      state.ray, stops ? BrickGradients::Missing::Stop : BrickGradients::Missing::OneSided,
      static_cast<float>(state.color.transmittance), this->Bricks, t};
  const std::size_t asked = this->Requests.entries().size();
  const int known = this->Shader->shade(this->Batch, needed, request, this->Requests, colors);
  if (!stops) {
    this->Statistics.missed += static_cast<std::int64_t>(this->Requests.entries().size() - asked);
  }
  for (int k = 0; k < known; ++k) {
    if (opacities[k] > 0.0f) {
      this->addLight(state, colors[k], opacities[k], t[k]);
    }
  }
  if (known < this->Count && state.color.transmittance > OpaqueTransmittance) {
    this->goBackTo(known, before, state);
  }
}

void CachedMarcher::goBackTo(int sample, const CachedRay& before, CachedRay& state)
{
  const Origin& origin = this->originOf(sample);
  this->Statistics.work.cells += state.samples.visited() - before.samples.visited();
  state.samples = before.samples;
  state.samples.resume(origin.interval + (sample - origin.sample) * origin.steps, origin.stretch,
                       this->Scene.settings);
  this->Statistics.samples -= this->Count - sample; // they will be counted again
  for (int k = sample; k < this->Count; ++k) {
    this->LevelSum -= this->originOf(k).level;
  }
  this->Awaited.reset(); // it waits for something nearer
  this->Waiting = true;
  this->Ended = false;
}

} // namespace inr
