// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/MarchedBatch.h"

#include <cstdint>

namespace inr {

/// What becomes of the samples of rays: one of the ways in which VTK blends them, for rays one
/// after another.
class CachedBlending
{
public:
  virtual ~CachedBlending() = default;

  /// Another ray is next, another part of its way, or one that has waited.
  virtual void begin() {}
  /// Takes a ray's next samples, unless it ends or has to wait.
  virtual void advance(CachedRay& ray) = 0;
  /// The ray has ended.
  virtual void finish(CachedRay& /*ray*/) const {}
  /// Found so far.
  virtual std::int64_t gradients() const { return 0; }
};

/// Those that take samples from front to back, each of a colour and opacity that need no other
/// place than the ray's: such can be lit.
class CachedColors : public CachedBlending
{
public:
  /// Straight RGB and opacity of the samples that the batch was filled with, and the opacities once
  /// more by themselves; until the ray is opaque or has to wait for a brick. How many these are.
  virtual int find(CachedRay& ray, glm::vec4* colors, float* opacities) = 0;
  /// Says that the ray goes on behind the first `count` of them, and `before` was what it knew in
  /// front of the batch.
  virtual void goOnBehind(int /*count*/, const KnownValue& /*before*/, CachedRay& /*ray*/) const {}
};

} // namespace inr
