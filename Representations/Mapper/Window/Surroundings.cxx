// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/Surroundings.h"

#include "Representations/Mapper/Window/OpaqueDepth.h"
#include "Representations/Mapper/Window/Props.h"

#include <vtkRenderer.h>
#include <vtkVolume.h>

#include <algorithm>
#include <cstddef>

namespace inr {

Surroundings Surroundings::in(const Viewport& viewport, int width, int height) const
{
  if (width == this->width && height == this->height) {
    return *this;
  }
  Surroundings result;
  result.width = width;
  result.height = height;
  result.depthRead = this->depthRead;
  if (!this->depth.empty()) {
    result.depth = ReduceDepth(this->depth, viewport, width, height);
  }
  if (this->layers) {
    result.layers = ReduceLayers(*this->layers, viewport, width, height);
  }
  return result;
}

Surroundings LookAround(vtkRenderer* renderer, const Viewport& viewport, const PictureGroup& group,
                        TranslucentPeeler* peeler)
{
  Surroundings around;
  around.width = viewport.width;
  around.height = viewport.height;
  group.together([&] {
    if (MayHaveOpaqueDepth(renderer)) {
      around.depth = ReadOpaqueDepth(renderer, viewport);
      around.depthRead = !around.depth.empty();
    }
  });
  group.share(around.depth, static_cast<std::size_t>(viewport.width) * viewport.height);
  if (peeler) {
    group.together([&] {
      around.layers = peeler->peel(renderer, viewport, TranslucentProps(renderer), around.depth);
    });
  }
  return around;
}

vtkMTimeType TimeOfChange(vtkRenderer* renderer, vtkVolume* volume)
{
  vtkMTimeType time = renderer->GetViewProps()->GetMTime(); // of what has come or gone
  ForEachProp(renderer, [&](vtkProp* prop) {
    if (prop != volume) {
      time = std::max(time, prop->GetRedrawMTime());
    }
  });
  return time;
}

} // namespace inr
