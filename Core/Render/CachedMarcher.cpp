// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/CachedMarcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

/// How often 2 divides k; more than enough for 0.
int PowerOfTwoIn(std::int64_t k)
{
  return k == 0 ? 62 : __builtin_ctzll(static_cast<std::uint64_t>(k));
}

/// value * 2^power.
double Doubled(double value, int power)
{
  return value * static_cast<double>(std::int64_t{1} << power);
}

} // namespace

CachedRay::CachedRay(const CachedScene& scene, int x, int y)
    : ray(scene.geometry.ray(x, y)),
      detail(this->ray, scene.frame.levelOfDetailScale, scene.cache.hierarchy().levels()),
      walker(scene.majorants, scene.settings.dims, this->ray, scene.frame.levelOfDetailScale,
             scene.cache.hierarchy().levels()),
      stream(PixelStream(scene.frame, x, y)), jitter(JitterOf(this->stream))
{
  this->detail.moveTo(0);
}

CachedMarcher::CachedMarcher(const CachedScene& scene, OnMiss onMiss)
    : Scene(scene), Missing(onMiss), StepsPerT(1.0 / scene.settings.step)
{
  if (scene.shading != nullptr) {
    this->Shader.emplace(*scene.shading, scene.colors,
                         BrickGradients(scene.cache, scene.format, scene.kernel));
  }
}

CachedRay CachedMarcher::begin(int x, int y)
{
  CachedRay ray(this->Scene, x, y);
  this->Statistics.rays += ray.ray.length > 0 ? 1 : 0;
  return ray;
}

bool CachedMarcher::march(CachedRay& state)
{
  this->Ended = false;
  this->Waiting = false;
  while (!this->Ended && !this->Waiting) {
    if (this->Shader) {
      this->advanceShaded(state);
    } else {
      this->place(state);
      this->Scene.kernel.sample(this->Scene.format, this->Batch, this->Count);
      this->composite(state);
    }
    this->Ended = this->Ended || state.color.transmittance <= OpaqueTransmittance;
  }
  this->close(this->Runs[0], state.color.transmittance);
  this->close(this->Runs[1], state.color.transmittance);
  return this->Ended;
}

void CachedMarcher::place(CachedRay& state)
{
  const double step = this->Scene.settings.step;
  this->Count = 0;
  this->Paths = 0;
  this->LastLength = 0;
  for (BrickRun& run : this->Runs) {
    if (run.level() >= 0) {
      this->enlist(run);
    }
  }
  while (this->Count < SampleBatch::Capacity && !this->Ended && !this->Waiting) {
    if (static_cast<double>(state.next) * step >= state.ray.length) {
      this->Ended = true;
      return;
    }
    state.walker.moveTo(this->firstPlace(state, state.next));
    if (state.walker.extinction() > 0.0f) {
      this->fill(state);
    } else if (state.walker.moveToVisible(state.ray.length)) {
      this->skipTo(state, state.walker.enter());
    } else {
      this->Ended = true;
    }
  }
}

int CachedMarcher::shortest(const CachedRay& state, std::int64_t k)
{
  return std::min(state.detail.coarsest(), PowerOfTwoIn(k));
}

double CachedMarcher::firstPlace(const CachedRay& state, std::int64_t k) const
{
  const double intervals = static_cast<double>(k) + Doubled(state.jitter, shortest(state, k));
  return std::min(intervals * this->Scene.settings.step, state.ray.length);
}

void CachedMarcher::skipTo(CachedRay& state, double t) const
{
  this->lookFrom(state, t);
  const int level = state.detail.coarsest();
  const double length = Doubled(this->Scene.settings.step, level);
  const auto first = static_cast<std::int64_t>(std::ceil(t / length - state.jitter));
  state.next = std::max(state.next + 1, first * (std::int64_t{1} << level));
}

void CachedMarcher::lookFrom(CachedRay& state, double t)
{
  state.detail.moveTo(t);
  state.lookedFrom = t;
}

CachedMarcher::Segment CachedMarcher::segmentAt(CachedRay& state) const
{
  const MarchSettings& settings = this->Scene.settings;
  const int adaptive =
      settings.adaptive ? 2 : 0; // at most 4 times as long where little can be seen
  const double depth = state.walker.extinction() * settings.unitsPerT * settings.step;
  this->lookFrom(state, state.walker.enter());
  int longest = state.detail.coarsest();
  for (int k = 0; k < adaptive && Doubled(depth, longest + 1) <= FaintDepth; ++k) {
    ++longest;
  }
  return {state.walker.exit(), longest};
}

CachedMarcher::Sampling CachedMarcher::samplingAt(const CachedRay& state, const Segment& segment,
                                                  int shortest) const
{
  const double limit = std::min(segment.exit, state.ray.length);
  // Longer samples than the level's own start at multiples of their length and end inside the cell.
  int multiple = std::max(std::min(segment.longest, PowerOfTwoIn(state.next)), shortest);
  const auto sampling = [](int multiple) {
    const double intervals = Doubled(1.0, multiple);
    return Sampling{multiple, intervals, 1.0 / intervals};
  };
  while (multiple > shortest && this->endOf(state, sampling(multiple), 0) > limit) {
    --multiple;
  }
  return sampling(multiple);
}

void CachedMarcher::fill(CachedRay& state)
{
  // The first sample's cell was found by what the ray looked at before.
  int shortest = CachedMarcher::shortest(state, state.next);
  double lookedFrom = state.lookedFrom;
  const Segment segment = this->segmentAt(state);
  while (this->Count < SampleBatch::Capacity) {
    const Sampling sampling = this->samplingAt(state, segment, shortest);
    const bool isLast = this->endOf(state, sampling, 0) > state.ray.length;
    const int most = this->likeSamples(state, segment, sampling, shortest);
    const int count = state.detail.isDithered() ? this->addDithered(state, sampling, most)
                                                : this->addAlike(state, sampling, most);
    if (this->Shader) {
      this->remember(state, sampling, lookedFrom, count);
    }
    if (isLast && count > 0) {
      this->LastLength = static_cast<float>((state.ray.length - this->endOf(state, sampling, -1)) *
                                            this->Scene.settings.unitsPerT);
      this->Ended = true;
    }
    state.next += static_cast<std::int64_t>(count) << sampling.multiple;
    const double begin = static_cast<double>(state.next) * this->Scene.settings.step;
    if (this->Waiting || this->Ended || begin >= state.ray.length ||
        this->firstPlace(state, state.next) >= segment.exit) {
      return;
    }
    shortest = CachedMarcher::shortest(state, state.next);
    lookedFrom = state.lookedFrom;
  }
}

void CachedMarcher::remember(const CachedRay& state, const Sampling& sampling, double lookedFrom,
                             int count)
{
  for (int k = 0; k < count; ++k) {
    const int sample = this->Count - count + k;
    this->Intervals[sample] = state.next + (static_cast<std::int64_t>(k) << sampling.multiple);
    this->LookedFrom[sample] = lookedFrom;
  }
}

int CachedMarcher::likeSamples(const CachedRay& state, const Segment& segment,
                               const Sampling& sampling, int shortest) const
{
  if (sampling.multiple < segment.longest) {
    return 1;
  }
  // Samples of the level's own length may reach out of the cell that they begin in.
  const bool reachesOut = sampling.multiple <= shortest;
  const auto fits = [&](int k) {
    const double end = this->endOf(state, sampling, k);
    return end <= state.ray.length &&
           (reachesOut ? this->placeOf(state, sampling, k) < segment.exit : end <= segment.exit);
  };
  const double first = this->endOf(state, sampling, 0);
  const double beyond = reachesOut ? first - this->placeOf(state, sampling, 0) : 0.0;
  const double room = std::min(segment.exit + beyond, state.ray.length) - first;
  const int most = SampleBatch::Capacity - this->Count;
  return 1 + this->largest(sampling, room, most - 1, fits);
}

template <typename Fits>
int CachedMarcher::largest(const Sampling& sampling, double room, int most, const Fits& fits) const
{
  // A guess by division, made good by what decides: where a batch begins must not matter.
  const double guess = room * (this->StepsPerT * sampling.inverse);
  int count = static_cast<int>(std::clamp(guess, 0.0, static_cast<double>(most)));
  while (count > 0 && !fits(count)) {
    --count;
  }
  while (count < most && fits(count + 1)) {
    ++count;
  }
  return count;
}

double CachedMarcher::placeOf(const CachedRay& state, const Sampling& sampling, int k) const
{
  const double interval = static_cast<double>(state.next) + k * sampling.intervals; // exact
  return (interval + state.jitter * sampling.intervals) * this->Scene.settings.step;
}

double CachedMarcher::endOf(const CachedRay& state, const Sampling& sampling, int k) const
{
  const double interval = static_cast<double>(state.next) + (k + 1) * sampling.intervals;
  return interval * this->Scene.settings.step;
}

int CachedMarcher::addAlike(const CachedRay& state, const Sampling& sampling, int most)
{
  const double first = this->placeOf(state, sampling, 0);
  BrickRun* run = this->runFor(state, state.detail.level(), std::min(first, state.ray.length));
  if (run == nullptr) {
    this->Waiting = true;
    return 0;
  }
  const int count = 1 + this->largest(sampling, run->exit() - first, most - 1, [&](int k) {
    return this->placeOf(state, sampling, k) < run->exit();
  });
  double* t = this->T + this->Count;
  for (int k = 0; k < count; ++k) {
    t[k] = std::min(this->placeOf(state, sampling, k), state.ray.length);
  }
  this->fillIn(state, *run, sampling.multiple, count);
  run->count(count);
  return count;
}

int CachedMarcher::addDithered(const CachedRay& state, const Sampling& sampling, int most)
{
  for (int k = 0; k < most; ++k) {
    const std::int64_t at = state.next + (static_cast<std::int64_t>(k) << sampling.multiple);
    const double t = std::min(this->placeOf(state, sampling, k), state.ray.length);
    BrickRun* run = this->runFor(state, state.detail.dithered(state.stream, at), t);
    if (run == nullptr) {
      this->Waiting = true;
      return k;
    }
    this->T[this->Count] = t;
    this->fillIn(state, *run, sampling.multiple, 1);
    run->count(1);
  }
  return most;
}

void CachedMarcher::fillIn(const CachedRay& state, const BrickRun& run, int multiple, int count)
{
  const ValueRange range =
      run.exact() ? state.walker.range() : state.walker.range(IdOf(run.served()).level);
  for (int k = this->Count; k < this->Count + count; ++k) {
    this->Batch.along[k] = run.along(this->T[k]);
    this->Batch.path[k] = run.place();
    this->Batch.multiple[k] = multiple;
    this->Batch.low[k] = range.low;
    this->Batch.high[k] = range.high;
  }
  this->Count += count;
}

BrickRun* CachedMarcher::runFor(const CachedRay& state, int level, double t)
{
  BrickRun& run = this->Runs[level & 1];
  if (run.covers(level, t)) {
    return &run;
  }
  this->close(run, state.color.transmittance);
  return this->open(run, state.ray, level, t) ? &run : nullptr;
}

bool CachedMarcher::open(BrickRun& run, const Ray& ray, int level, double t)
{
  const BrickCache& cache = this->Scene.cache;
  const Hierarchy& hierarchy = cache.hierarchy();
  const BrickSpan wanted = SpanAt(hierarchy, level, ray, t);
  BrickSpan served = wanted;
  std::int32_t slot = cache.find(wanted.key);
  if (slot < 0 && this->Missing == OnMiss::Stop) {
    this->Requests.add(wanted.key, 1, 1.0f);
    return false;
  }
  for (int coarser = level + 1; slot < 0 && coarser < hierarchy.levels(); ++coarser) {
    served = SpanAt(hierarchy, coarser, ray, t);
    slot = cache.find(served.key);
  }
  cache.touch(slot);
  run.open(level, wanted, served, cache.view(slot), hierarchy);
  if (this->Missing == OnMiss::Approach && !run.exact()) {
    const int next = IdOf(served.key).level - 1;
    run.wishFor(KeyOf(hierarchy.brickAt(next, ray.at(t))));
  }
  this->enlist(run);
  return true;
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
  if (run.count() > 0 && !run.exact()) {
    this->Statistics.missed += run.count();
    this->Requests.add(run.wish(), static_cast<std::uint32_t>(run.count()),
                       static_cast<float>(run.count()) * transmittance);
  }
  run.close();
}

void CachedMarcher::advanceShaded(CachedRay& state)
{
  const CachedRay before = state; // gradients may ask for bricks that are not there
  this->place(state);
  this->Scene.kernel.sample(this->Scene.format, this->Batch, this->Count);
  this->clampToRanges();
  const bool stops = this->Missing == OnMiss::Stop;
  const SampleShader::Request request{
      state.ray, stops ? BrickGradients::Missing::Stop : BrickGradients::Missing::OneSided,
      state.color.transmittance};
  const std::size_t asked = this->Requests.entries().size();
  glm::vec4 colors[SampleBatch::Capacity];
  const int known = this->Shader->shade(this->Batch, this->Bricks, this->T, this->Count, request,
                                        this->Requests, colors);
  if (!stops) {
    this->Statistics.missed += static_cast<std::int64_t>(this->Requests.entries().size() - asked);
  }
  this->compositeShaded(state, colors, known);
  if (known < this->Count && state.color.transmittance > OpaqueTransmittance) {
    this->goBackTo(known, before, state);
  }
}

void CachedMarcher::goBackTo(int k, const CachedRay& before, CachedRay& state)
{
  state.next = this->Intervals[k];
  state.walker = before.walker;
  this->lookFrom(state, this->LookedFrom[k]);
  this->Statistics.samples -= this->Count - k; // they will be counted again
  this->Waiting = true;
  this->Ended = false;
}

} // namespace inr
