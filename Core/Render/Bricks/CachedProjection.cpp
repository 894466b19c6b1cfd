// SPDX-License-Identifier: BSD-3-Clause
//
// What CachedMarcher does with the values of a batch where they are projected.
#include "Core/Render/Bricks/CachedMarcher.h"

namespace inr {

bool CachedMarcher::isDone(const CachedRay& state) const
{
  return state.color.transmittance <= OpaqueTransmittance ||
         this->Scene.settings.projector.isFinal(state.projection);
}

void CachedMarcher::project(CachedRay& state)
{
  this->clampToRanges();
  const MarchSettings& settings = this->Scene.settings;
  for (int k = 0; k < this->Placed.count; ++k) {
    settings.projector.add(this->Scene.colors, this->Batch.value[k], this->lengthOf(k),
                           this->timeOf(state, k), state.projection);
  }
}

void CachedMarcher::finishProjection(CachedRay& state) const
{
  if (!(state.ray.length > 0)) {
    return;
  }
  const glm::vec4 color =
      this->Scene.settings.projector.color(this->Scene.colors, state.projection);
  state.color = {{color.x, color.y, color.z}, 1.0f - color.w, state.color.ofMany};
  state.halfOpaqueAt = color.w >= 0.5f ? state.projection.at : -1.0;
}

} // namespace inr
