// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickCache.h"
#include "Core/Render/BrickKernel.h"
#include "Core/Render/Ray.h"

namespace inr {

/// What kernels need to know about the bricks of a cache.
BrickFormat FormatOf(const BrickCache& cache);

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

/// Samples of one ray that fall into one brick.
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
            const Hierarchy& hierarchy);
  void close()
  {
    this->Level = -1;
    this->Count = 0;
  }

  double exit() const { return this->Exit; }
  /// Length along `path()` at t.
  float along(double t) const { return static_cast<float>(t - this->Reference); }
  void count(int samples) { this->Count += samples; }

  const BrickPath& path() const { return this->Path; }
  /// The path's number in the batch being filled.
  int place() const { return this->Place; }
  void setPlace(int place) { this->Place = place; }

  int level() const { return this->Level; }
  bool exact() const { return this->Exact; } ///< served == wanted
  BrickKey served() const { return this->Served; }
  /// The brick to load, which is the wanted one unless said otherwise.
  BrickKey wish() const { return this->Wish; }
  void wishFor(BrickKey brick) { this->Wish = brick; }
  int count() const { return this->Count; } ///< samples so far

private:
  int Level = -1;
  double Enter = 0;
  double Exit = 0;
  double Reference = 0; ///< t at the origin
  BrickPath Path{};
  int Place = 0;
  bool Exact = false;
  BrickKey Served = 0;
  BrickKey Wish = 0;
  int Count = 0;
};

} // namespace inr
