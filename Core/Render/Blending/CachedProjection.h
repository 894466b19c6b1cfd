// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedBlending.h"

namespace inr {

/// Samples projected: what is shown of a ray is its largest, smallest or average value, or the sum
/// of all.
class CachedProjection : public CachedBlending
{
public:
  /// The batch must outlive it.
  explicit CachedProjection(MarchedBatch& batch) : Batch(batch), Scene(batch.scene()) {}

  void advance(CachedRay& ray) override;
  void finish(CachedRay& ray) const override;

private:
  MarchedBatch& Batch;
  const CachedScene& Scene;
};

} // namespace inr
