// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/RayProbe.h"
#include "Core/Render/Bricks/SamplePlacer.h"
#include "Core/Render/Bricks/SampleShader.h"
#include "Core/Render/Marching/RayMarching.h"
#include "Core/Render/Scene/FrameStatistics.h"

#include <cstdint>
#include <optional>

namespace inr {

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
  SampleTally tally() const { return {this->Notes.statistics.samples, this->Notes.levelSum}; }
  RequestList& requests() { return this->Notes.requests; }

private:
  /// The same for the part of the way that the ray is on.
  bool marchPart(CachedRay& ray);
  /// Fills the batch and finds its values, unless the ray ends or has to wait.
  void sample(CachedRay& state);
  /// Puts the ray back to before a sample of the batch, which began at `before`.
  void goBackTo(int sample, const SampleWalker& before, CachedRay& state);
  double timeOf(const CachedRay& state, int sample) const;
  /// Opacity unit distances that a sample of the batch stands for.
  double lengthOf(int sample) const;
  void composite(CachedRay& state);
  /// The ray's last sample, which the batch ends with.
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
  bool findBegin(const CachedRay& state, const SampleOrigin& origin, int place, int sample);
  /// Whether what a sample of the batch stands for is in front of the ray.
  bool isInFront(int sample) const;
  /// Samples [first, end), of which it is known where they begin.
  void compositeKnown(CachedRay& state, int first, int end);
  /// Makes coordinates of the values of samples [first, end), where colours are logarithmic.
  void takeCoordinates(int first, int end);
  /// Colours and opacities of the batch's samples until the ray is opaque; how many these are.
  int findOpacities(const CachedRay& state, glm::vec4* colors, float* opacities);
  /// The same of what has the colours of all values that it passes, and until a brick is not there.
  int findIntegrated(CachedRay& state, glm::vec4* colors, float* opacities);
  /// Lights the first `count` samples; for how many of them that was possible.
  int shade(const CachedRay& state, int count, glm::vec4* colors);
  /// What is known of the field behind a sample of the batch.
  KnownValue knownBehind(int sample) const;
  void compositeColor(CachedRay& state, const glm::vec4& color, float length, double t);
  /// Whether light was halved by that, and not before.
  bool addLight(CachedRay& state, const glm::vec4& color, float opacity);
  void project(CachedRay& state);
  void finishProjection(CachedRay& state) const;
  bool isDone(const CachedRay& state) const;
  void advanceSurfaces(CachedRay& state);
  /// A sample of the batch and the surfaces in front of it; false when a brick is not there.
  bool crossSurfaces(CachedRay& state, int sample);
  bool drawSurface(CachedRay& state, float value, int level, double place);
  void clampToRanges();
  /// A sample's value into what its macro-cell may hold; whether by more than the storage rounds.
  bool moveIntoRange(int sample);
  /// Of the first `count` samples.
  void takeLogarithms(int count);

  // Those with batches of their own first: they begin at cache lines.
  std::optional<SampleShader> Shader;
  SamplePlacer Placer;
  std::optional<RayProbe> Probe; ///< where both ends of samples are looked at
  const CachedScene& Scene;
  OnMiss Missing;
  IntegralLookup Integrals{}; ///< where there are any
  MarchNotes Notes;
  const PlacedSamples& Placed; ///< by the placer
  SampleBatch& Batch;          ///< of these
  std::uint64_t Clamped = 0; ///< those of the batch's samples that clampToRanges moved, bit by bit
};

} // namespace inr
