// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedProjection.h"

namespace inr {

void CachedProjection::advance(CachedRay& ray)
{
  this->Batch.fill(ray);
  this->Batch.clampToRanges();
  const Projector& projector = this->Scene.settings.projector;
  for (int k = 0; k < this->Batch.placed().count; ++k) {
    projector.add(this->Scene.colors, this->Batch.samples().value[k], this->Batch.lengthOf(k),
                  this->Batch.timeOf(ray, k), ray.projection);
  }
}

void CachedProjection::finish(CachedRay& ray) const
{
  if (!(ray.ray.length > 0)) {
    return;
  }
  const glm::vec4 color = this->Scene.settings.projector.color(this->Scene.colors, ray.projection);
  ray.color = {{color.x, color.y, color.z}, 1.0f - color.w, ray.color.ofMany};
  ray.halfOpaqueAt = color.w >= 0.5f ? ray.projection.at : -1.0;
}

} // namespace inr
