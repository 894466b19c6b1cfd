// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Render/BrickKernel.h"
#include "Core/Render/Ray.h"

namespace inr {

/// The part [enter, exit) of a ray that one brick covers.
struct BrickSpan
{
  BrickKey key;
  double enter;
  double exit;
  glm::dvec3 origin;    ///< the brick's local coordinates at `enter`
  glm::dvec3 direction; ///< and their change per unit of t
};

/// The brick of `level` at t, and the ray's way through it. The outermost bricks reach as far as
/// the ray does. A function of ray and brick only: where in the brick t lies makes no difference.
BrickSpan SpanAt(const Hierarchy& hierarchy, int level, const Ray& ray, double t);

/// Samples of one ray that fall into one brick, gathered to be interpolated together.
class BrickRun
{
public:
  /// Whether a sample of `level` at t belongs here.
  bool covers(int level, double t) const
  {
    return level == this->Level && t >= this->Enter && t < this->Exit;
  }
  /// An empty run of samples that want `wanted` of `level` and are read from `served` (the same, or
  /// of a coarser level), a mapped brick in `view`.
  void open(int level, const BrickSpan& wanted, const BrickSpan& served, const BrickView& view,
            const Hierarchy& hierarchy, CachePrecision precision);
  void close() { this->Level = -1; }

  /// `weight`: the most that the sample can add to the opacity.
  void add(double t, int sample, float weight)
  {
    this->Weight += weight;
    this->T[this->Count] = static_cast<float>(t - this->Reference);
    this->Sample[this->Count++] = sample;
  }
  int count() const { return this->Count; }
  float weight() const { return this->Weight; } ///< of the samples added so far
  /// Interpolates the samples added so far into values[sample] and forgets them.
  void resolve(const BrickKernel& kernel, float* values);

  bool exact() const { return this->Exact; } ///< served == wanted
  BrickKey wanted() const { return this->Wanted; }

private:
  int Level = -1;
  double Enter = 0;
  double Exit = 0;
  double Reference = 0; ///< t at the path's origin
  bool Exact = false;
  BrickKey Wanted = 0;
  BrickPath Path{};
  int Count = 0;
  float Weight = 0;
  int Sample[SampleBatch::Capacity];
  float T[SampleBatch::Capacity] = {};
};

} // namespace inr
