// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedBlending.h"

#include <memory>

namespace inr {

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

  FrameStatistics statistics();
  SampleTally tally() const { return this->Batch.tally(); }
  RequestList& requests() { return this->Batch.requests(); }

private:
  /// The same for the part of the way that the ray is on.
  bool marchPart(CachedRay& ray);
  /// Nothing behind where the ray is could be seen.
  bool isDone(const CachedRay& ray) const;

  MarchedBatch Batch;
  std::unique_ptr<CachedBlending> Blending;
};

} // namespace inr
