// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedBlending.h"
#include "Core/Render/Bricks/RayProbe.h"

namespace inr {

/// Samples of the colours of all values since the one before, composited: pre-integration.
class CachedIntegration : public CachedColors
{
public:
  /// The batch must outlive it.
  explicit CachedIntegration(MarchedBatch& batch);

  void begin() override { this->Probe.leave(); }
  void advance(CachedRay& ray) override;
  int find(CachedRay& ray, glm::vec4* colors, float* opacities) override;
  void goOnBehind(int count, const KnownValue& before, CachedRay& ray) const override;

private:
  /// Finds the values where what the batch's samples stand for begins, until a brick is not there;
  /// of how many that was possible.
  int findBegins(CachedRay& ray);
  /// That of the sample at a place of a run's: the value before, or if no such sample was taken,
  /// what the field is there.
  bool findBegin(const CachedRay& ray, const SampleOrigin& origin, int place, int sample);
  /// Whether what a sample stands for is in front of the ray.
  bool isInFront(int sample) const;
  /// Samples [first, end), of which it is known where they begin.
  void compositeKnown(CachedRay& ray, int first, int end);
  /// Makes coordinates of the values of samples [first, end), where colours are logarithmic.
  void takeCoordinates(int first, int end);

  MarchedBatch& Batch;
  const CachedScene& Scene;
  const PlacedSamples& Placed; ///< in the batch
  SampleBatch& Samples;        ///< of these
  RayProbe Probe;
  IntegralLookup Integrals;
};

} // namespace inr
