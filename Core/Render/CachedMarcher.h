// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/Requests.h"
#include "Core/Render/BrickRun.h"
#include "Core/Render/CellWalker.h"
#include "Core/Render/LevelOfDetail.h"
#include "Core/Render/RayMarching.h"
#include "Core/Render/SampleShader.h"

#include <cstdint>
#include <optional>

namespace inr {

/// What a frame's rays share when they read from the cache. All read-only.
struct CachedScene
{
  const Frame& frame;
  const RayGeometry& geometry;
  const Majorants& majorants;
  const ColorLookup& colors;
  const StepLookup& steps;
  const BrickCache& cache;
  const BrickKernel& kernel;
  BrickFormat format; ///< of the cache's bricks
  MarchSettings settings;
  const Shading* shading; ///< null: colours as the transfer function gives them
};

/// Where a ray stands. Its samples sit on a lattice of its own, t = (k + jitter) * step.
struct CachedRay
{
  CachedRay(const CachedScene& scene, int x, int y);

  Ray ray;
  LevelOfDetail detail;
  CellWalker walker;
  std::uint64_t stream;  ///< of the ray's random numbers
  double jitter;         ///< in [0, 1)
  std::int64_t next = 0; ///< lattice interval to look at next
  double lookedFrom = 0; ///< t of the present detail
  RayColor color{{0, 0, 0}, 1};
  double halfOpaqueAt = -1; ///< t where opacity reached one half; -1 = not yet
};

/// What a ray does where the brick it wants is not there.
enum class OnMiss {
  UseCoarser, ///< read the nearest coarser level that is, and wish for the wanted one
  Approach,   ///< the same, but wish for the level after the coarser one
  Stop        ///< wait
};

/// Marches rays through the brick cache, one at a time, and notes which bricks they missed. One for
/// each thread and tile.
class CachedMarcher
{
public:
  CachedMarcher(const CachedScene& scene, OnMiss onMiss);

  /// The ray through the centre of pixel (x, y), at its start.
  CachedRay begin(int x, int y);
  /// True when the ray is done, false when it waits for a brick. The same ray gives the same
  /// picture however often it had to wait. The coarsest level must be mapped.
  bool march(CachedRay& ray);

  const FrameStatistics& statistics() const { return this->Statistics; }
  RequestList& requests() { return this->Requests; }

private:
  /// What the samples in one macro-cell have in common.
  struct Segment
  {
    double exit;
    int longest; ///< log2 of the most steps a sample may stand for
  };

  struct Sampling
  {
    int multiple;     ///< log2 of the steps a sample stands for
    double intervals; ///< these steps
    double inverse;   ///< 1 / intervals
  };

  void place(CachedRay& state);
  /// log2 of the steps that a sample from interval k on stands for at least: those of the level.
  static int shortest(const CachedRay& state, std::int64_t k);
  /// Where such a sample is; in its macro-cell.
  double firstPlace(const CachedRay& state, std::int64_t k) const;
  /// Goes on with the first sample at t or behind it.
  void skipTo(CachedRay& state, double t) const;
  /// Takes the level of detail that t deserves.
  static void lookFrom(CachedRay& state, double t);
  Segment segmentAt(CachedRay& state) const;
  Sampling samplingAt(const CachedRay& state, const Segment& segment, int shortest) const;
  /// Where the latest `count` samples came from, should the ray have to go back to one.
  void remember(const CachedRay& state, const Sampling& sampling, double lookedFrom, int count);
  /// Adds the samples in the walker's cell.
  void fill(CachedRay& state);
  /// How many samples from state.next on differ in nothing but their place.
  int likeSamples(const CachedRay& state, const Segment& segment, const Sampling& sampling,
                  int shortest) const;
  /// t of sample k from state.next on, but for the ray's end, and where what it stands for ends.
  double placeOf(const CachedRay& state, const Sampling& sampling, int k) const;
  double endOf(const CachedRay& state, const Sampling& sampling, int k) const;
  /// The largest of 0 ... most that `fits`, if all below do and 0 in any case; about as many
  /// samples as there are in a length of `room`.
  template <typename Fits>
  int largest(const Sampling& sampling, double room, int most, const Fits& fits) const;
  /// Add up to `most` such samples, of one level and brick or of dithered levels; how many.
  int addAlike(const CachedRay& state, const Sampling& sampling, int most);
  int addDithered(const CachedRay& state, const Sampling& sampling, int most);
  BrickRun* runFor(const CachedRay& state, int level, double t);
  /// Puts down what `count` samples on the way through the run's brick have in common.
  void fillIn(const CachedRay& state, const BrickRun& run, int multiple, int count);
  bool open(BrickRun& run, const Ray& ray, int level, double t);
  void close(BrickRun& run, float transmittance);
  void enlist(BrickRun& run);
  void composite(CachedRay& state);
  void compositeLast(CachedRay& state);
  void advanceShaded(CachedRay& state);
  void compositeShaded(CachedRay& state, const glm::vec4* colors, int count);
  void compositeColor(CachedRay& state, const glm::vec4& color, float length, double t);
  void clampToRanges();
  /// Puts the ray back to before sample k of the batch, which began at `before`.
  void goBackTo(int k, const CachedRay& before, CachedRay& state);
  void takeLogarithms();

  const CachedScene& Scene;
  OnMiss Missing;
  double StepsPerT;
  FrameStatistics Statistics;
  RequestList Requests;

  BrickRun Runs[2]; ///< of even and of odd levels: dithering alternates between two neighbours
  SampleBatch Batch{};
  double T[SampleBatch::Capacity];
  std::int64_t Intervals[SampleBatch::Capacity]; ///< lattice interval at which a sample begins
  double LookedFrom[SampleBatch::Capacity];      ///< when the sample's cell was looked for
  BrickKey Bricks[SampleBatch::Capacity + 2];    ///< of the batch's paths
  int Count = 0;
  int Paths = 0;        ///< in Batch
  float LastLength = 0; ///< of the ray's last sample, if it is shorter than a step; else 0
  bool Waiting = false;
  bool Ended = false;
  std::optional<SampleShader> Shader;
};

} // namespace inr
