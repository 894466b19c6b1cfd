// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedBlending.h"
#include "Core/Render/Bricks/RayProbe.h"

namespace inr {

/// Isosurfaces between samples, each drawn where a ray crosses it.
class CachedSurfaces : public CachedBlending
{
public:
  /// The batch must outlive it.
  explicit CachedSurfaces(MarchedBatch& batch)
      : Batch(batch), Scene(batch.scene()), Probe(batch.scene(), batch.missing())
  {}

  void begin() override { this->Probe.leave(); }
  void advance(CachedRay& ray) override;
  std::int64_t gradients() const override { return this->Probe.gradients(); }

private:
  /// A sample and the surfaces in front of it; false when a brick is not there.
  bool cross(CachedRay& ray, int sample);
  /// The surface of a value at a place; false as above.
  bool draw(CachedRay& ray, float value, int level, double place);

  MarchedBatch& Batch;
  const CachedScene& Scene;
  RayProbe Probe;
};

} // namespace inr
