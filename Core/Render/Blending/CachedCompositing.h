// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedBlending.h"

namespace inr {

/// Samples of the colours of their own values, composited.
class CachedCompositing : public CachedColors
{
public:
  /// The batch must outlive it.
  explicit CachedCompositing(MarchedBatch& batch) : Batch(batch), Scene(batch.scene()) {}

  void advance(CachedRay& ray) override;
  int find(CachedRay& ray, glm::vec4* colors, float* opacities) override;

private:
  /// Those that stand for whole steps.
  void composite(CachedRay& ray);
  /// The ray's last one.
  void compositeLast(CachedRay& ray);

  MarchedBatch& Batch;
  const CachedScene& Scene;
};

} // namespace inr
