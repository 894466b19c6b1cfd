// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/CachedRay.h"
#include "Core/Render/Bricks/MarchNotes.h"
#include "Core/Render/Bricks/OnMiss.h"
#include "Core/Render/Bricks/PlacedSamples.h"
#include "Core/Render/Bricks/RayBricks.h"
#include "Core/Render/Rays/CroppedWay.h"

#include <cstdint>
#include <optional>

namespace inr {

/// Places samples along rays, one ray after another and batch by batch, and finds the bricks that
/// they are read from. Those that show nothing are left out.
///
/// A ray, or a part of its way, begins with `begin`; then `place` fills one batch after another,
/// until the ray has ended or waits; then `finish`, once, counts what it has taken.
class SamplePlacer
{
public:
  /// The references must outlive it.
  SamplePlacer(const CachedScene& scene, OnMiss onMiss, MarchNotes& notes);
  SamplePlacer(const SamplePlacer&) = delete;
  SamplePlacer& operator=(const SamplePlacer&) = delete;

  /// Another ray is next, another part of its way, or one that has waited.
  void begin(const CachedRay& ray);
  /// Fills the batch with the ray's next samples. There may be fewer than there is room for, or
  /// none, and the ray may have ended or wait behind them.
  void place(CachedRay& ray);
  const PlacedSamples& placed() const { return this->Placed; }
  /// Of these, for whoever finds their values and makes colours of them.
  SampleBatch& batch() { return this->Placed.batch; }
  /// Chooses how many samples the next batch is for, after one that took the ray's transmittance
  /// from `before` to `after`: what lies behind an opaque sample is placed in vain, and every batch
  /// has its price.
  void adaptRoom(double before, double after);
  /// Puts the ray back to before a sample of the latest batch, which began at `before`: it waits,
  /// and has not ended. Only where something may be looked up at samples, that is, with shading or
  /// where both ends of samples are looked at.
  void goBackTo(int sample, const SampleWalker& before, CachedRay& ray);
  /// Notes what the ray has taken, and what it waits for.
  void finish(const CachedRay& ray);

  /// Nothing of the ray is left that could be seen.
  bool ended() const { return this->Ended; }
  void end() { this->Ended = true; }
  /// For a brick that is not there.
  bool waits() const { return this->Waiting; }

private:
  /// Whether the first of alike samples is; leaves those in `alike` of which the same is true.
  bool isCropped(const CachedRay& ray, AlikeSamples& alike) const;
  /// Whether samples in these would make the batch longer than what one knows of the ray is good
  /// for.
  bool looksTooFar(const RunPair& runs) const;
  /// Which of such samples are taken, of these, which may add to the picture, and whose own values
  /// may be seen: what lies between those and their neighbours may be, too.
  struct SampleBits
  {
    std::uint64_t taken;
    std::uint64_t seen;
    std::uint64_t visible;
  };
  /// Whether from one such sample to the next there may be blocks, besides those of the two, of
  /// which all values are looked at.
  bool spansBlocks(const AlikeSamples& alike, const RunPair& runs) const;
  SampleBits choose(const CachedRay& ray, const AlikeSamples& alike, int count,
                    const RunPair& runs) const;
  /// Which of the first of them may show something.
  std::uint64_t findShown(const CachedRay& ray, const AlikeSamples& alike, int count,
                          const BrickRun& run) const;
  /// The same of samples that are in one of two bricks each.
  std::uint64_t findShownOnTwo(const CachedRay& ray, const AlikeSamples& alike, int count,
                               const RunPair& runs) const;
  /// Adds such samples, the first of them at `place`, but for those that show nothing, as far as
  /// they share bricks and the batch has room. Leaves in `alike` those that it has come past, of
  /// which there are some.
  void add(CachedRay& ray, AlikeSamples& alike, const RunPair& runs, double place);
  void addRun(const CachedRay& ray, const AlikeSamples& alike, int count, const SampleBits& bits,
              const RunPair& runs);
  /// Where such samples are, but for the places of their bricks in the batch.
  void placeRun(const CachedRay& ray, const AlikeSamples& alike, const RunPair& runs,
                SampleRun& run) const;
  /// Of the latest run, which is on two paths, counts the samples to be expected of the coarser
  /// level.
  void noteCoarser(const RunPair& runs, int count);
  void countUse(const CachedRay& ray, const AlikeSamples& alike, std::uint64_t taken,
                const RunPair& runs) const;
  /// The number that chooses between two levels for a sample. A surface would be torn where one
  /// sample is of this and the next of that level, so of its rays all have the same.
  std::int64_t ditherOf(std::int64_t interval) const { return interval & this->DitherMask; }
  void enlist(BrickRun& run);

  const CachedScene& Scene;
  MarchNotes& Notes;
  RayBricks Bricks;
  bool LooksAtBothEnds;    ///< of samples
  bool MayGoBack;          ///< as what is found at samples may want bricks that are not there
  int MostRoom;            ///< of all batches
  std::int64_t DitherMask; ///< of sample numbers
  double ShortestBlock;    ///< edge in voxels: the last one along an axis may be cut off

  int Room = 0;             ///< samples that the batch is for
  std::int64_t Visited = 0; ///< macro-cells, by the present ray before it was begun
  int Ahead = 0; ///< samples, those left out included, from the batch's first to where it ends
  std::optional<CroppedWay> Cropped;
  bool Waiting = false;
  bool Ended = false;
  PlacedSamples Placed;
};

} // namespace inr
