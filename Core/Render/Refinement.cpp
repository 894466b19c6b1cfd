// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Refinement.h"

namespace inr {

Refinement::Refinement(const CachedScene& scene, const PassOutput& soFar)
    : Picture(scene.frame),
      Geometry(this->Picture.frame(), scene.bricks->cache().hierarchy().dims()),
      Lighting(ShadingOf(this->Picture.frame())),
      Scene{this->Picture.frame(), this->Geometry,
            scene.majorants,       scene.colors,
            scene.steps,           scene.bricks,
            scene.kernel,          scene.format,
            scene.settings,        this->Lighting ? &*this->Lighting : nullptr,
            scene.blocks,          scene.seen},
      Pass(this->Scene), Pixels(soFar)
{}

WorkDone Refinement::advance(const Arena& arena, const std::function<bool()>& keepGoing,
                             RequestRanking& requests)
{
  return this->Pass.advance(arena, keepGoing, this->Pixels.output(), requests);
}

} // namespace inr
