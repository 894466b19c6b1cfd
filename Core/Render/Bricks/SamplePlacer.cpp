// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/SamplePlacer.h"

#include "Core/Render/Bricks/SampleBits.h"
#include "Core/Render/Marching/StepLattice.h"
#include "Core/Render/Marching/StepTable.h"

#include <algorithm>

namespace inr {

namespace {

/// Samples that a ray's first batch is for.
constexpr int FirstRoom = 32;
/// And, at most, one of samples that are looked at one by one: of these there is a bit for each.
constexpr int MostSingle = 64;

double ShortestBlockOf(const BrickFormat& format)
{
  const double edge = 1.0 / static_cast<double>(format.blocksPerVoxel);
  double shortest = edge;
  for (int axis = 0; axis < 3; ++axis) {
    shortest = std::min(shortest, format.lastCell[axis] + 1 - format.lastBlock[axis] * edge);
  }
  return shortest;
}

/// Part of a run's samples, of which there are `count` with those left out, that are on its coarser
/// path.
float MeanFraction(const SampleRun& run, int count)
{
  const float middle =
      run.start[0] + 0.5f * static_cast<float>(count - 1) * run.spacing + run.offset;
  return std::min(std::max(run.fraction + run.growth * middle, 0.0f), 1.0f);
}

} // namespace

SamplePlacer::SamplePlacer(const CachedScene& scene, OnMiss onMiss, MarchNotes& notes)
    : Scene(scene), Notes(notes), Bricks(scene, onMiss, notes),
      LooksAtBothEnds(scene.settings.looksAtBothEnds()),
      MayGoBack(this->LooksAtBothEnds || scene.shading != nullptr),
      MostRoom(this->MayGoBack || scene.settings.projector.projects() ? MostSingle
                                                                      : SampleBatch::Capacity),
      DitherMask(scene.settings.projector.findsSurfaces() ? 0 : ~std::int64_t{0}),
      ShortestBlock(ShortestBlockOf(scene.format))
{}

void SamplePlacer::begin(const CachedRay& ray)
{
  this->Visited = ray.samples.visited();
  this->Room = FirstRoom;
  this->Ended = false;
  this->Waiting = false;
  this->Bricks.begin();
  if (this->Scene.settings.crops) {
    this->Cropped.emplace(this->Scene.settings.cropping, ray.ray, this->Scene.settings.step);
  }
}

void SamplePlacer::finish(const CachedRay& ray)
{
  this->Bricks.finish(ray.color.transmittance, this->Ended);
  this->Notes.statistics.work.cells += ray.samples.visited() - this->Visited;
}

void SamplePlacer::adaptRoom(double before, double after)
{
  constexpr double little = 0.1;
  if (after < 0.5 * before || after < little) {
    this->Room = FirstRoom;
  } else if (after < 1.0 && after > 0.75 * before) {
    this->Room = std::min(2 * this->Room, this->MostRoom);
  }
}

void SamplePlacer::goBackTo(int sample, const SampleWalker& before, CachedRay& ray)
{
  const SampleOrigin& origin = this->Placed.originOf(sample);
  this->Notes.statistics.work.cells += ray.samples.visited() - before.visited();
  ray.samples = before;
  ray.samples.resume(origin.intervalOf(sample), origin.stretch, this->Scene.settings);
  ray.shownTo = origin.intervalOf(sample); // this one is wanted, whether it shows something
  this->Notes.statistics.samples -= this->Placed.count - sample; // they will be counted again
  const int taken = sample - origin.sample;
  this->Notes.statistics.hidden = origin.hidden + PlaceOfBit(origin.shown, taken) - taken;
  for (int k = sample; k < this->Placed.count; ++k) {
    this->Notes.levelSum -= this->Placed.originOf(k).level;
  }
  this->Bricks.turnBack();
  this->Waiting = true;
  this->Ended = false;
}

// Flat: what it calls it calls for every brick and macro-cell of every ray.
__attribute__((flatten)) void SamplePlacer::place(CachedRay& ray)
{
  this->Placed.clear();
  this->Ahead = 0;
  this->Bricks.leaveBatch();
  const MarchSettings& settings = this->Scene.settings;
  while (this->Placed.count < this->Room && !this->Ended && !this->Waiting) {
    if (!ray.samples.moveToVisible(settings)) {
      this->Ended = true;
      return;
    }
    AlikeSamples alike = ray.samples.alike();
    if (settings.projector.canSkip(ray.projection, ray.samples.stretch().range) ||
        (this->Cropped && this->isCropped(ray, alike))) {
      ray.samples.pass(alike, alike.count);
      ray.shownTo = CachedRay::Unknown;
      continue;
    }
    const double place = static_cast<double>(ray.samples.next()) + ray.samples.offset(alike);
    const RunPair runs =
        this->Bricks.at(ray.ray, ray.samples.detail(), ray.color.transmittance, place);
    if (runs.fine == nullptr || runs.coarse == nullptr) {
      this->Waiting = true;
      return;
    }
    if (this->looksTooFar(runs)) {
      return;
    }
    const int before = this->Placed.count;
    this->add(ray, alike, runs, place);
    this->Ahead += this->Placed.count > 0 ? alike.count : 0;
    if (alike.last && this->Placed.count > before) {
      this->Placed.lastLength =
          static_cast<float>(ray.samples.rest() * settings.step * settings.unitsPerT);
      this->Ended = true;
    }
    ray.samples.pass(alike, alike.count);
  }
}

bool SamplePlacer::isCropped(const CachedRay& ray, AlikeSamples& alike) const
{
  const double place = static_cast<double>(ray.samples.next()) + ray.samples.offset(alike);
  const double end = this->Cropped->end(place);
  alike.count = CountBelow((end - place) / static_cast<double>(alike.steps()), alike.count);
  return !this->Cropped->shows(place);
}

// Inline: called once per run of samples, and there are as many of them as of bricks.
inline void SamplePlacer::placeRun(const CachedRay& ray, const AlikeSamples& alike,
                                   const RunPair& runs, SampleRun& run) const
{
  const SampleWalker& samples = ray.samples;
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
    run.seed = DitherSeed(ray.stream);
    run.counter = static_cast<std::uint32_t>(this->ditherOf(samples.next()));
    run.stride = static_cast<std::uint32_t>(this->ditherOf(alike.steps()));
  }
}

inline void SamplePlacer::addRun(const CachedRay& ray, const AlikeSamples& alike, int count,
                                 const SampleBits& bits, const RunPair& runs)
{
  const SampleWalker& samples = ray.samples;
  const SampleStretch& stretch = samples.stretch();
  const BrickRun& fine = *runs.fine;
  // A coarser brick than the one wanted may hold anything. Where one of two is as wanted, and all
  // samples may turn out to be from that one, they count as such; the others are missed anyway.
  const bool mayBeExact = fine.exact() || runs.coarse->exact();
  const ValueRange range = mayBeExact ? stretch.range : ValueRange{0.0f, 1.0f};
  SampleRun& run = this->Placed.batch.runs[this->Placed.runs];
  this->placeRun(ray, alike, runs, run);
  run.path[0] = fine.place();
  run.path[1] = runs.coarse->place();
  run.count = count;
  run.shown = bits.taken;
  run.length = LengthOf(alike.joined, alike.power);
  run.low = range.low;
  run.high = range.high;
  // One by one: a whole one made elsewhere would be waited for until it can be read.
  SampleOrigin& origin = this->Placed.origins[this->Placed.runs++];
  origin.sample = this->Placed.count;
  origin.offset = samples.offset(alike);
  origin.interval = samples.next();
  origin.steps = alike.steps();
  origin.shown = bits.taken;
  origin.seen = bits.seen;
  origin.hidden = this->Notes.statistics.hidden;
  if (this->MayGoBack) {
    origin.stretch = stretch;
  }
  origin.level = static_cast<float>(fine.servedLevel());
  if (runs.fine != runs.coarse) {
    this->noteCoarser(runs, alike.count);
  }
  this->Placed.count += count;
}

// Not inline: it is rare, and place() is long enough.
__attribute__((noinline)) void SamplePlacer::noteCoarser(const RunPair& runs, int count)
{
  const SampleRun& run = this->Placed.batch.runs[this->Placed.runs - 1];
  const auto apart = static_cast<float>(runs.coarse->servedLevel() - runs.fine->servedLevel());
  const float coarser = MeanFraction(run, count) * apart;
  this->Placed.origins[this->Placed.runs - 1].level += coarser;
  if (runs.fine->exact() && runs.coarse->exact()) { // which countUse takes for the finer one's
    this->Notes.levelSum += static_cast<double>(coarser) * run.count;
    this->Notes.statistics.levels.add({runs.fine->servedLevel(), runs.coarse->servedLevel()});
  }
}

inline void SamplePlacer::countUse(const CachedRay& ray, const AlikeSamples& alike,
                                   std::uint64_t taken, const RunPair& runs) const
{
  const int count = CountBits(taken);
  if (runs.fine == runs.coarse || (runs.fine->exact() && runs.coarse->exact())) {
    runs.fine->count(count); // of two, no wish depends on which it was
    return;
  }
  // As if all were visible in the one and nothing in the other: only the kernel knows to the last
  // bit where it reads a sample.
  static constexpr ShownBlocks all{ShownBlocks::Kind::All, {}};
  static constexpr ShownBlocks none{ShownBlocks::Kind::None, {}};
  SampleRun run;
  this->placeRun(ray, alike, runs, run);
  const std::uint64_t onFine = this->Scene.kernel.findShownOnTwo(
      this->Scene.format, {&all, &none}, {&runs.fine->path(), &runs.coarse->path()}, run,
      alike.count);
  const int fine = CountBits(taken & onFine);
  runs.fine->count(fine);
  runs.coarse->count(count - fine);
}

bool SamplePlacer::looksTooFar(const RunPair& runs) const
{
  // So many samples behind the first one it may turn out that the ray is opaque.
  constexpr int inUse = 128;
  constexpr int toBeLoaded = 32;
  if (this->Placed.count == 0 || this->Ahead < toBeLoaded) {
    return false;
  }
  const bool exact = runs.fine->exact() && runs.coarse->exact();
  return !exact || this->Ahead >= inUse;
}

std::uint64_t SamplePlacer::findShown(const CachedRay& ray, const AlikeSamples& alike, int count,
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
  const SampleRow row{run.along(static_cast<double>(ray.samples.next())),
                      static_cast<float>(alike.steps()),
                      static_cast<float>(ray.samples.offset(alike))};
  return this->Scene.kernel.findShown(this->Scene.format, run.shown(), run.path(), row, count);
}

std::uint64_t SamplePlacer::findShownOnTwo(const CachedRay& ray, const AlikeSamples& alike,
                                           int count, const RunPair& runs) const
{
  SampleRun run;
  this->placeRun(ray, alike, runs, run);
  return this->Scene.kernel.findShownOnTwo(this->Scene.format,
                                           {&runs.fine->shown(), &runs.coarse->shown()},
                                           {&runs.fine->path(), &runs.coarse->path()}, run, count);
}

SamplePlacer::SampleBits SamplePlacer::choose(const CachedRay& ray, const AlikeSamples& alike,
                                              int count, const RunPair& runs) const
{
  if (!this->LooksAtBothEnds) {
    const std::uint64_t visible = runs.coarse == runs.fine
                                      ? this->findShown(ray, alike, count, *runs.fine)
                                      : this->findShownOnTwo(ray, alike, count, runs);
    return {visible, visible, visible};
  }
  // What is seen in neither is left out, whichever a sample would be from: of samples that are not
  // taken, too, it is asked what is seen there.
  const std::uint64_t visible =
      this->findShown(ray, alike, count, *runs.fine) |
      (runs.coarse != runs.fine ? this->findShown(ray, alike, count, *runs.coarse) : 0);
  const bool follows = ray.shownTo == CachedRay::Unknown || ray.shownTo == ray.samples.next();
  const std::uint64_t seen = (visible | visible << 1 | (follows ? 1 : 0)) & LowestBits(count);
  return {seen | seen >> 1, seen, visible};
}

bool SamplePlacer::spansBlocks(const AlikeSamples& alike, const RunPair& runs) const
{
  const double voxels = static_cast<double>(alike.steps()) * this->Scene.settings.step;
  const double level = PowerOfTwo(runs.fine->servedLevel());
  return this->LooksAtBothEnds && voxels > level * this->ShortestBlock;
}

void SamplePlacer::add(CachedRay& ray, AlikeSamples& alike, const RunPair& runs, double place)
{
  const SampleStretch& stretch = ray.samples.stretch();
  // Closed stretches take values for others than those that ranges bound.
  const bool all = (stretch.closed && stretch.level > 0) || this->spansBlocks(alike, runs) ||
                   (runs.fine->shown().kind == ShownBlocks::Kind::All &&
                    runs.coarse->shown().kind == ShownBlocks::Kind::All);
  const int room = std::min(this->Room - this->Placed.count, SampleRow::Most);
  int count = std::min(alike.count, all ? room : SampleRow::Most);
  if (count > 1) {
    const double length = std::min(runs.fine->exit(), runs.coarse->exit()) - place;
    count = CountBelow(length / static_cast<double>(alike.steps()), count);
  }
  SampleBits bits{LowestBits(count), LowestBits(count), LowestBits(count)};
  int taken = count;
  if (!all) {
    bits = this->choose(ray, alike, count, runs);
    taken = CountBits(bits.taken);
    if (taken > room) {
      count = PlaceOfBit(bits.taken, room);
      bits.taken &= LowestBits(count);
      taken = room;
    }
  }
  alike.count = count;
  if (this->LooksAtBothEnds) {
    const bool isLastVisible = (bits.visible >> (count - 1) & 1) != 0;
    ray.shownTo = isLastVisible ? ray.samples.next() + count * alike.steps() : CachedRay::Nowhere;
  }
  if (taken == 0) {
    this->Notes.statistics.hidden += count;
    return;
  }
  for (BrickRun* run : {runs.fine, runs.coarse}) {
    if (run->place() < 0) {
      this->enlist(*run);
    }
  }
  this->addRun(ray, alike, taken, bits, runs);
  this->Notes.statistics.hidden += count - taken;
  this->countUse(ray, alike, bits.taken, runs);
}

void SamplePlacer::enlist(BrickRun& run)
{
  run.setPlace(this->Placed.paths);
  this->Placed.bricks[this->Placed.paths] = run.served();
  this->Placed.batch.paths[this->Placed.paths++] = run.path();
}

} // namespace inr
