// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/CachedScene.h"
#include "Core/Render/CroppedWay.h"
#include "Core/Render/RayMarching.h"
#include "Core/Render/RayProbe.h"
#include "Core/Render/SampleShader.h"

#include <cstdint>
#include <optional>

namespace inr {

/// A value of the field as a level has it.
struct KnownValue
{
  std::int64_t at = -2; ///< place on the ray, of the end of an interval of its lattice; -2 = none
  int level = -1;
  float value = 0;
};

/// Samples and, of each, the level that it came from, summed up.
struct SampleTally
{
  std::int64_t samples = 0;
  std::int64_t levels = 0;
};

/// Where a ray stands.
struct CachedRay
{
  CachedRay(const CachedScene& scene, int x, int y);

  static constexpr std::int64_t Unknown = -3; ///< shownTo: nothing was looked at right before
  static constexpr std::int64_t Nowhere = -2; ///< shownTo: what was right before is invisible

  Ray ray;
  std::uint64_t stream; ///< of the ray's random numbers
  SampleWalker samples;
  RayColor color{{0, 0, 0}, 1};
  double halfOpaqueAt = -1; ///< t where opacity reached one half; -1 = not yet
  SampleTally tally;        ///< of what it took
  Projection projection{};  ///< instead, of values that are projected
  KnownValue known;         ///< the latest, where both ends of samples are looked at
  /// There, the interval behind the latest sample, if that may show something.
  std::int64_t shownTo = Unknown;

  int x;
  int y;
  int part = 0; ///< of the way: how many translucent layers lie behind
  LayeredLight light;
  double halfOpaqueDepth = -1; ///< in window space, once on another part of the way; -1 = not yet
};

/// Marches rays through the brick cache, one at a time, and notes which bricks they missed. One for
/// each thread and tile.
class CachedMarcher
{
public:
  CachedMarcher(const CachedScene& scene, OnMiss onMiss);
  CachedMarcher(const CachedMarcher&) = delete;
  CachedMarcher& operator=(const CachedMarcher&) = delete;

  /// The ray through the centre of pixel (x, y), at its start.
  CachedRay begin(int x, int y);
  /// True when the ray is done, false when it waits for a brick. The same ray gives the same
  /// picture however often it had to wait. The coarsest level must be mapped.
  bool march(CachedRay& ray);

  FrameStatistics statistics() const;
  SampleTally tally() const { return {this->Statistics.samples, this->LevelSum}; }
  RequestList& requests() { return this->Requests; }
  /// Bricks in whose place a coarser one was read.
  RequestList& absent() { return this->Absent; }

private:
  /// How the samples of a run came about, should the ray have to go back to one.
  struct Origin
  {
    int sample;            ///< the first one, in the batch
    double offset;         ///< from a sample's interval to its place
    std::int64_t interval; ///< at which the first one begins
    std::int64_t steps;    ///< that each stands for
    std::uint64_t shown;   ///< see SampleRun
    std::uint64_t seen;    ///< of these bits, of samples that may add to the picture
    std::int64_t hidden;   ///< samples left out before
    SampleStretch stretch; ///< where the ray may go back
    int level;             ///< that they came from
  };

  /// A part of a ray at whose ends the field is on different sides of surfaces.
  struct SurfaceInterval
  {
    int level;
    double begin; ///< places
    double end;
    float first; ///< values there
    float last;
  };

  /// The same for the part of the way that the ray is on.
  bool marchPart(CachedRay& ray);
  /// Sends a ray on behind the translucent layer at its end; false when there is nothing to see.
  bool enterNextPart(CachedRay& ray) const;
  /// Chooses how many samples the next batch is for, after one that took the ray's transmittance
  /// from `before` to `after`: what lies behind an opaque sample is placed in vain, and every batch
  /// has its price.
  void adaptRoom(double before, double after);
  /// Fills the batch, unless the ray ends or has to wait.
  void place(CachedRay& state);
  /// Whether the first of such samples is; leaves those in `alike` of which the same is true.
  bool isCropped(const CachedRay& state, AlikeSamples& alike) const;
  /// The bricks that such samples are read from, of the finer level and of the coarser one, which
  /// may be the same; null where the ray has to wait.
  struct RunPair
  {
    BrickRun* fine;
    BrickRun* coarse;
  };
  RunPair runsFor(const CachedRay& state, double place);
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
  SampleBits choose(const CachedRay& state, const AlikeSamples& alike, int count,
                    const RunPair& runs) const;
  /// Adds such samples, the first of them at `place`, but for those that show nothing, as far as
  /// they share bricks and the batch has room. Leaves in `alike` those that it has come past, of
  /// which there are some.
  void add(CachedRay& state, AlikeSamples& alike, const RunPair& runs, double place);
  /// Which of the first of them may show something.
  std::uint64_t findShown(const CachedRay& state, const AlikeSamples& alike, int count,
                          const BrickRun& run) const;
  /// The same of samples that are in one of two bricks each.
  std::uint64_t findShownOnTwo(const CachedRay& state, const AlikeSamples& alike, int count,
                               const RunPair& runs) const;
  /// Where such samples are, but for the places of their bricks in the batch.
  void placeRun(const CachedRay& state, const AlikeSamples& alike, const RunPair& runs,
                SampleRun& run) const;
  void addRun(const CachedRay& state, const AlikeSamples& alike, int count, const SampleBits& bits,
              const RunPair& runs);
  BrickRun* runFor(const CachedRay& state, int level, double place);
  void countUse(const CachedRay& state, const AlikeSamples& alike, std::uint64_t taken,
                const RunPair& runs) const;
  /// The number that chooses between two levels for a sample. A surface would be torn where one
  /// sample is of this and the next of that level, so of its rays all have the same.
  std::int64_t ditherOf(std::int64_t interval) const { return interval & this->DitherMask; }
  bool open(BrickRun& run, const Ray& ray, int level, double place);
  /// What is there instead of a brick that is not: the slot.
  std::int32_t openCoarser(BrickRun& run, const Ray& ray, const BrickWay& wanted, double t);
  void close(BrickRun& run, float transmittance);
  void enlist(BrickRun& run);
  const Origin& originOf(int sample) const;
  static std::int64_t intervalOf(const Origin& origin, int sample);
  /// Of the brick that a sample of the batch is read from.
  int levelOf(int sample) const { return IdOf(this->Bricks[this->Batch.path[sample]]).level; }
  double timeOf(const CachedRay& state, int sample) const;
  void composite(CachedRay& state);
  void compositeLast(CachedRay& state);
  /// Notes where light was halved if that was in samples [first, end), and not before.
  void noteHalfOpaque(CachedRay& state, int first, int end) const;
  void advanceShaded(CachedRay& state);
  void advanceIntegrated(CachedRay& state);
  /// Finds the values where what the batch's samples stand for begins, until a brick is not there;
  /// of how many that was possible.
  int findBegins(CachedRay& state);
  /// That of the sample at a place of a run's: the value before, or if no such sample was taken,
  /// what the field is there.
  bool findBegin(const CachedRay& state, const Origin& origin, int place, int sample);
  /// Whether what a sample of the batch stands for is in front of the ray.
  bool isInFront(int sample) const;
  /// Samples [first, end), of which it is known where they begin.
  void compositeKnown(CachedRay& state, int first, int end);
  /// Makes coordinates of the values of samples [first, end), where colours are logarithmic.
  void takeCoordinates(int first, int end);
  /// Colours and opacities of the batch's samples until the ray is opaque; how many these are.
  int findOpacities(const CachedRay& state, glm::vec4* colors, float* opacities) const;
  /// The same of what has the colours of all values that it passes, and until a brick is not there.
  int findIntegrated(CachedRay& state, glm::vec4* colors, float* opacities);
  /// Opacity unit distances that a sample of the batch stands for.
  double lengthOf(int sample) const;
  /// Lights the first `count` samples, which are at `t`; for how many of them that was possible.
  int shade(const CachedRay& state, int count, const double* t, glm::vec4* colors);
  /// What is known of the field behind a sample of the batch.
  KnownValue knownBehind(int sample) const;
  void compositeColor(CachedRay& state, const glm::vec4& color, float length, double t);
  void addLight(CachedRay& state, const glm::vec4& color, float opacity, double t);
  void project(CachedRay& state);
  void finishProjection(CachedRay& state) const;
  bool isDone(const CachedRay& state) const;
  void advanceSurfaces(CachedRay& state);
  /// A sample of the batch and the surfaces in front of it; false when a brick is not there.
  bool crossSurfaces(CachedRay& state, int sample);
  bool drawSurfaces(CachedRay& state, const SurfaceInterval& interval);
  bool drawSurface(CachedRay& state, int surface, int level, double place);
  bool findSurface(const CachedRay& state, const SurfaceInterval& interval, float value,
                   double& place);
  void clampToRanges();
  /// Whether what is found at samples may want bricks that are not there.
  bool mayGoBack() const { return this->Shader || this->Probe; }
  /// Puts the ray back to before a sample of the batch, which began at `before`.
  void goBackTo(int sample, const SampleWalker& before, CachedRay& state);
  void takeLogarithms();

  const CachedScene& Scene;
  OnMiss Missing;
  FrameStatistics Statistics;
  std::int64_t LevelSum = 0;
  std::int64_t Visited = 0; ///< macro-cells, by the present ray before it was marched
  RequestList Requests;
  RequestList Absent;

  BrickWay Ways[2]; ///< of even and of odd levels, along the present ray
  BrickRun Runs[2]; ///< of even and of odd levels: dithering alternates between two neighbours
  SampleBatch Batch{};
  Origin Origins[SampleBatch::Capacity];          ///< of its runs
  BrickKey Bricks[2 * SampleBatch::Capacity + 2]; ///< of the batch's paths
  int Count = 0;
  int Room = 0;  ///< samples that the batch is for
  int Ahead = 0; ///< samples, those left out included, from the batch's first to where it ends
  std::optional<BrickKey> Awaited; ///< by the next sample
  int RunCount = 0;                ///< in Batch
  int Paths = 0;                   ///< in Batch
  std::int64_t DitherMask;         ///< of sample numbers
  double ShortestBlock;            ///< edge in voxels: the last one along an axis may be cut off
  std::uint64_t Clamped = 0; ///< those of the batch's samples that clampToRanges moved, bit by bit
  float LastLength = 0;      ///< of the ray's last sample, if it is shorter than a step; else 0
  bool Waiting = false;
  bool Ended = false;
  std::optional<SampleShader> Shader;
  IntegralLookup Integrals{};    ///< where there are any
  std::optional<RayProbe> Probe; ///< where both ends of samples are looked at
  std::optional<CroppedWay> Cropped;
};

} // namespace inr
