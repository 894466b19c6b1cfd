// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/CachedScene.h"
#include "Core/Render/Marching/KnownValue.h"
#include "Core/Render/Rays/LayeredWay.h"

#include <glm/vec4.hpp>

#include <cstdint>

namespace inr {

/// Samples and, of each, the level that it came from, summed up; where levels are mixed, the one to
/// be expected.
struct SampleTally
{
  std::int64_t samples = 0;
  double levels = 0;
};

/// Where a ray stands.
struct CachedRay
{
  /// At the beginning; the ray may miss the volume.
  CachedRay(const CachedScene& scene, int x, int y);
  /// Goes on behind the translucent layer at its end; false when there is nothing to see.
  bool enterNextPart(const CachedScene& scene);
  /// Puts a straight colour behind what it has gathered; whether light was halved by that, and not
  /// before.
  bool addLight(const glm::vec4& added, float opacity);
  /// The same of a colour that is at `t`, of opacity added.w per unit distance, over `length` of
  /// these; notes whether light was halved there.
  void composite(const glm::vec4& added, float length, double t);

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
  LayeredWay layered;
};

} // namespace inr
