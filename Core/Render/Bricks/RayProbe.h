// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/BrickGradients.h"
#include "Core/Render/Bricks/CachedScene.h"

#include <glm/vec3.hpp>

namespace inr {

/// Looks at a ray's field point by point, through the cache. Points count steps of t.
class RayProbe
{
public:
  RayProbe(const CachedScene& scene, OnMiss onMiss);

  /// Another ray is next.
  void leave() { this->Run.close(); }
  /// The value at a place as `level` has it or, where that brick is not there, the nearest coarser
  /// one; false if the ray is to stop for it. What was not there comes out of `requests`, worth
  /// `contribution`.
  bool find(const Ray& ray, int level, double place, float contribution, RequestList& requests,
            float& value);
  /// The gradient where `find` was last, per voxel of level 0; false as above.
  bool findGradient(float contribution, RequestList& requests, glm::vec3& gradient);

  std::int64_t gradients() const { return this->Gradients.found(); } ///< so far

private:
  bool open(const Ray& ray, int level, double place, float contribution, RequestList& requests);

  const CachedScene& Scene;
  bool Stops;
  BrickRun Run;
  BrickKey Brick = 0;
  SampleBatch Batch{}; ///< of one sample
  BrickGradients Gradients;
};

} // namespace inr
