// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/SamplePlacer.h"

#include <cstdint>

namespace inr {

/// The next samples of a ray with their values, from the brick cache: what all ways of making a
/// picture of them begin with. Large, and begins at a cache line.
class MarchedBatch
{
public:
  /// The scene must outlive it.
  MarchedBatch(const CachedScene& scene, OnMiss onMiss)
      : Placer(scene, onMiss, this->Notes), Scene(scene), Missing(onMiss)
  {}
  MarchedBatch(const MarchedBatch&) = delete;
  MarchedBatch& operator=(const MarchedBatch&) = delete;

  SamplePlacer& placer() { return this->Placer; }
  const PlacedSamples& placed() const { return this->Placer.placed(); }
  /// The values among it, for whoever makes colours of them.
  SampleBatch& samples() { return this->Placer.batch(); }
  const CachedScene& scene() const { return this->Scene; }
  OnMiss missing() const { return this->Missing; }
  FrameStatistics& statistics() { return this->Notes.statistics; }
  RequestList& requests() { return this->Notes.requests; }
  /// Of all rays so far.
  SampleTally tally() const { return {this->Notes.statistics.samples, this->Notes.levelSum}; }

  /// Fills itself with a ray's next samples and finds their values, unless the ray ends or has to
  /// wait.
  void fill(CachedRay& ray);
  /// Puts the ray back to before a sample, which began at `before`: the ray waits.
  void goBackTo(int sample, const SampleWalker& before, CachedRay& ray);

  /// t of a sample.
  double timeOf(const CachedRay& ray, int sample) const;
  /// Opacity unit distances that a sample stands for.
  double lengthOf(int sample) const;
  /// The number of those that stand for whole steps: all, or all but the ray's last one.
  int whole() const { return this->placed().count - (this->placed().lastLength > 0 ? 1 : 0); }

  /// Moves all values into what their macro-cells may hold, and counts those that were outside by
  /// more than the storage rounds.
  void clampToRanges();
  /// The same of the first `count` values, and makes coordinates of them, for logarithmic colours:
  /// no range bounds those.
  void takeLogarithms(int count);
  /// The same of a single value, without making a coordinate of it.
  void clampToRange(int sample);

  /// Notes where light was halved if that was in samples [first, end), which a kernel composited,
  /// and not before.
  void noteHalfOpaque(CachedRay& ray, int first, int end) const;

private:
  bool moveIntoRange(int sample);

  SamplePlacer Placer; // first: it has a batch, which begins at a cache line
  MarchNotes Notes;
  const CachedScene& Scene;
  OnMiss Missing;
  std::uint64_t Clamped = 0; ///< samples that clampToRanges moved, bit by bit
};

} // namespace inr
