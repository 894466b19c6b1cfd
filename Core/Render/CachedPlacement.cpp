// SPDX-License-Identifier: BSD-3-Clause
//
// How CachedMarcher fills a batch with samples, and finds the bricks that they are read from.
#include "Core/Render/CachedMarcher.h"
#include "Core/Render/SampleBits.h"
#include "Core/Render/StepTable.h"

#include <algorithm>

namespace inr {

namespace {

void ShowKnown(const BlockSet& known, ShownBlocks& shown)
{
  shown.kind = known.isAll() ? ShownBlocks::Kind::All : ShownBlocks::Kind::Some;
  std::copy(known.words.begin(), known.words.end(), shown.words);
}

} // namespace

// Flat: what it calls it calls for every brick and macro-cell of every ray.
__attribute__((flatten)) void CachedMarcher::place(CachedRay& state)
{
  this->Count = 0;
  this->RunCount = 0;
  this->Paths = 0;
  this->LastLength = 0;
  this->Ahead = 0;
  this->Runs[0].setPlace(-1);
  this->Runs[1].setPlace(-1);
  const MarchSettings& settings = this->Scene.settings;
  while (this->Count < this->Room && !this->Ended && !this->Waiting) {
    if (!state.samples.moveToVisible(settings)) {
      this->Ended = true;
      return;
    }
    AlikeSamples alike = state.samples.alike();
    if (settings.projector.canSkip(state.projection, state.samples.stretch().range) ||
        (this->Cropped && this->isCropped(state, alike))) {
      state.samples.pass(alike, alike.count);
      state.shownTo = CachedRay::Unknown;
      continue;
    }
    const double place = static_cast<double>(state.samples.next()) + state.samples.offset(alike);
    const RunPair runs = this->runsFor(state, place);
    if (runs.fine == nullptr || runs.coarse == nullptr) {
      this->Waiting = true;
      return;
    }
    if (this->looksTooFar(runs)) {
      return;
    }
    const int before = this->Count;
    this->add(state, alike, runs, place);
    this->Ahead += this->Count > 0 ? alike.count : 0;
    if (alike.last && this->Count > before) {
      this->LastLength =
          static_cast<float>(state.samples.rest() * settings.step * settings.unitsPerT);
      this->Ended = true;
    }
    state.samples.pass(alike, alike.count);
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
inline void CachedMarcher::placeRun(const CachedRay& state, const AlikeSamples& alike,
                                    const RunPair& runs, SampleRun& run) const
{
  const SampleWalker& samples = state.samples;
  const auto begin = static_cast<double>(samples.next());
  run.start[0] = runs.fine->along(begin);
  run.start[1] = runs.coarse->along(begin);
  run.spacing = static_cast<float>(alike.steps());
  run.offset = static_cast<float>(samples.offset(alike));
  run.ways = 1;
  if (samples.detail().isDithered()) {
    const double growth = samples.detail().fractionGrowth() * this->Scene.settings.step;
    const double fraction = samples.detail().fractionAtEntry() + growth * runs.fine->reference();
    run.ways = 2;
    run.fraction = static_cast<float>(fraction);
    run.growth = static_cast<float>(growth);
    run.seed = DitherSeed(state.stream);
    run.counter = static_cast<std::uint32_t>(this->ditherOf(samples.next()));
    run.stride = static_cast<std::uint32_t>(this->ditherOf(alike.steps()));
  }
}

inline void CachedMarcher::addRun(const CachedRay& state, const AlikeSamples& alike, int count,
                                  const SampleBits& bits, const RunPair& runs)
{
  const SampleWalker& samples = state.samples;
  const SampleStretch& stretch = samples.stretch();
  const BrickRun& fine = *runs.fine;
  // A coarser brick than the one wanted may hold anything.
  const bool exact = fine.exact() && runs.coarse->exact();
  const ValueRange range = exact ? stretch.range : ValueRange{0.0f, 1.0f};
  SampleRun& run = this->Batch.runs[this->RunCount];
  this->placeRun(state, alike, runs, run);
  run.path[0] = fine.place();
  run.path[1] = runs.coarse->place();
  run.count = count;
  run.shown = bits.taken;
  run.length = LengthOf(alike.joined, alike.power);
  run.low = range.low;
  run.high = range.high;
  // One by one: a whole one made elsewhere would be waited for until it can be read.
  Origin& origin = this->Origins[this->RunCount++];
  origin.sample = this->Count;
  origin.offset = samples.offset(alike);
  origin.interval = samples.next();
  origin.steps = alike.steps();
  origin.shown = bits.taken;
  origin.seen = bits.seen;
  origin.hidden = this->Statistics.hidden;
  if (this->mayGoBack()) {
    origin.stretch = stretch;
  }
  origin.level = fine.servedLevel();
  this->Count += count;
}

inline void CachedMarcher::countUse(const CachedRay& state, const AlikeSamples& alike,
                                    std::uint64_t taken, const RunPair& runs) const
{
  const int count = CountBits(taken);
  if (runs.fine == runs.coarse || (runs.fine->exact() && runs.coarse->exact())) {
    runs.fine->count(count); // of two, nobody asks which it was
    return;
  }
  // As if all were visible in the one and nothing in the other: only the kernel knows to the last
  // bit where it reads a sample.
  static constexpr ShownBlocks all{ShownBlocks::Kind::All, {}};
  static constexpr ShownBlocks none{ShownBlocks::Kind::None, {}};
  SampleRun run;
  this->placeRun(state, alike, runs, run);
  const std::uint64_t onFine = this->Scene.kernel.findShownOnTwo(
      this->Scene.format, {&all, &none}, {&runs.fine->path(), &runs.coarse->path()}, run,
      alike.count);
  const int fine = CountBits(taken & onFine);
  runs.fine->count(fine);
  runs.coarse->count(count - fine);
}

CachedMarcher::RunPair CachedMarcher::runsFor(const CachedRay& state, double place)
{
  const LevelOfDetail& detail = state.samples.detail();
  BrickRun* fine = this->runFor(state, detail.level(), place);
  return {fine, detail.isDithered() ? this->runFor(state, detail.level() + 1, place) : fine};
}

bool CachedMarcher::looksTooFar(const RunPair& runs) const
{
  // So many samples behind the first one it may turn out that the ray is opaque.
  constexpr int inUse = 128;
  constexpr int toBeLoaded = 32;
  if (this->Count == 0 || this->Ahead < toBeLoaded) {
    return false;
  }
  const bool exact = runs.fine->exact() && runs.coarse->exact();
  return !exact || this->Ahead >= inUse;
}

std::uint64_t CachedMarcher::findShown(const CachedRay& state, const AlikeSamples& alike, int count,
                                       const BrickRun& run) const
{
  switch (run.shown().kind) {
  case ShownBlocks::Kind::All:
    return LowestBits(count);
  case ShownBlocks::Kind::None:
    return 0;
  case ShownBlocks::Kind::Some:
    break;
  }
  const SampleRow row{run.along(static_cast<double>(state.samples.next())),
                      static_cast<float>(alike.steps()),
                      static_cast<float>(state.samples.offset(alike))};
  return this->Scene.kernel.findShown(this->Scene.format, run.shown(), run.path(), row, count);
}

std::uint64_t CachedMarcher::findShownOnTwo(const CachedRay& state, const AlikeSamples& alike,
                                            int count, const RunPair& runs) const
{
  SampleRun run;
  this->placeRun(state, alike, runs, run);
  return this->Scene.kernel.findShownOnTwo(this->Scene.format,
                                           {&runs.fine->shown(), &runs.coarse->shown()},
                                           {&runs.fine->path(), &runs.coarse->path()}, run, count);
}

CachedMarcher::SampleBits CachedMarcher::choose(const CachedRay& state, const AlikeSamples& alike,
                                                int count, const RunPair& runs) const
{
  if (!this->Probe) {
    const std::uint64_t visible = runs.coarse == runs.fine
                                      ? this->findShown(state, alike, count, *runs.fine)
                                      : this->findShownOnTwo(state, alike, count, runs);
    return {visible, visible, visible};
  }
  // What is seen in neither is left out, whichever a sample would be from: of samples that are not
  // taken, too, it is asked what is seen there.
  const std::uint64_t visible =
      this->findShown(state, alike, count, *runs.fine) |
      (runs.coarse != runs.fine ? this->findShown(state, alike, count, *runs.coarse) : 0);
  const bool follows = state.shownTo == CachedRay::Unknown || state.shownTo == state.samples.next();
  const std::uint64_t seen = (visible | visible << 1 | (follows ? 1 : 0)) & LowestBits(count);
  return {seen | seen >> 1, seen, visible};
}

bool CachedMarcher::spansBlocks(const AlikeSamples& alike, const RunPair& runs) const
{
  const double voxels = static_cast<double>(alike.steps()) * this->Scene.settings.step;
  const double level = PowerOfTwo(runs.fine->servedLevel());
  return this->Probe && voxels > level * this->ShortestBlock;
}

void CachedMarcher::add(CachedRay& state, AlikeSamples& alike, const RunPair& runs, double place)
{
  const SampleStretch& stretch = state.samples.stretch();
  // Closed stretches take values for others than those that ranges bound.
  const bool all = (stretch.closed && stretch.level > 0) || this->spansBlocks(alike, runs) ||
                   (runs.fine->shown().kind == ShownBlocks::Kind::All &&
                    runs.coarse->shown().kind == ShownBlocks::Kind::All);
  const int room = std::min(this->Room - this->Count, SampleRow::Most);
  int count = std::min(alike.count, all ? room : SampleRow::Most);
  if (count > 1) {
    const double length = std::min(runs.fine->exit(), runs.coarse->exit()) - place;
    count = CountBelow(length / static_cast<double>(alike.steps()), count);
  }
  SampleBits bits{LowestBits(count), LowestBits(count), LowestBits(count)};
  int taken = count;
  if (!all) {
    bits = this->choose(state, alike, count, runs);
    taken = CountBits(bits.taken);
    if (taken > room) {
      count = PlaceOfBit(bits.taken, room);
      bits.taken &= LowestBits(count);
      taken = room;
    }
  }
  alike.count = count;
  if (this->Probe) {
    const bool isLastVisible = (bits.visible >> (count - 1) & 1) != 0;
    state.shownTo =
        isLastVisible ? state.samples.next() + count * alike.steps() : CachedRay::Nowhere;
  }
  if (taken == 0) {
    this->Statistics.hidden += count;
    return;
  }
  for (BrickRun* run : {runs.fine, runs.coarse}) {
    if (run->place() < 0) {
      this->enlist(*run);
    }
  }
  this->addRun(state, alike, taken, bits, runs);
  this->Statistics.hidden += count - taken;
  this->countUse(state, alike, bits.taken, runs);
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
  const BrickCache& cache = this->Scene.bricks.cache();
  const Hierarchy& hierarchy = cache.hierarchy();
  const double t = place * this->Scene.settings.step;
  BrickWay& wanted = this->Ways[level & 1];
  if (wanted.level() != level) {
    wanted = BrickWay(hierarchy.view(), level, ray);
  }
  wanted.moveTo(t);
  const BrickKey key = wanted.brick();
  std::int32_t slot = this->Scene.bricks.find(key);
  if (slot >= 0) {
    run.open(wanted, wanted, cache.view(slot), this->Scene.settings.step);
  } else if (this->Missing == OnMiss::Stop) {
    this->Awaited = key;
    return false;
  } else {
    slot = this->openCoarser(run, ray, wanted, t);
  }
  cache.touch(slot);
  if (!run.exact()) { // a coarser brick may hide what is there, but what is not known is invisible
    ShowKnown(cache.blocks().known(slot), run.shown());
  } else if (this->Scene.blocks != nullptr) {
    this->Scene.blocks->find(slot, run.shown());
  }
  return true;
}

std::int32_t CachedMarcher::openCoarser(BrickRun& run, const Ray& ray, const BrickWay& wanted,
                                        double t)
{
  const BrickCache& cache = this->Scene.bricks.cache();
  const Hierarchy& hierarchy = cache.hierarchy();
  BrickKey wish = wanted.brick();
  this->Absent.add(wish, 0.0f);
  for (int level = wanted.level() + 1;; ++level) { // the coarsest is there
    BrickWay served(hierarchy.view(), level, ray);
    served.moveTo(t);
    const std::int32_t slot = this->Scene.bricks.find(served.brick());
    if (slot >= 0) {
      run.open(wanted, served, cache.view(slot), this->Scene.settings.step);
      if (this->Missing == OnMiss::Approach) {
        run.wishFor(wish);
      }
      return slot;
    }
    this->Absent.add(served.brick(), 0.0f);
    wish = IsOnTheWay(level) ? served.brick() : wish;
  }
}

void CachedMarcher::enlist(BrickRun& run)
{
  run.setPlace(this->Paths);
  this->Bricks[this->Paths] = run.served();
  this->Batch.paths[this->Paths++] = run.path();
}

} // namespace inr
