// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Refinement.h"

namespace inr {

namespace {

Frame WithDepth(Frame frame, const std::vector<float>& depth)
{
  frame.opaqueDepth = depth.empty() ? nullptr : depth.data();
  return frame;
}

} // namespace

Refinement::Refinement(const CachedScene& scene, const PassOutput& soFar)
    : OpaqueDepth(CopyOfDepth(scene.frame)), Picture(WithDepth(scene.frame, this->OpaqueDepth)),
      Geometry(this->Picture, scene.bricks.cache().hierarchy().dims()),
      Lighting(ShadingOf(this->Picture)),
      Scene{this->Picture,   this->Geometry,
            scene.majorants, scene.colors,
            scene.steps,     scene.bricks,
            scene.kernel,    scene.format,
            scene.settings,  this->Lighting ? &*this->Lighting : nullptr,
            scene.blocks,    scene.seen},
      Pass(this->Scene), Pixels(soFar)
{}

WorkDone Refinement::advance(const Arena& arena, const std::function<bool()>& keepGoing,
                             RequestRanking& requests)
{
  return this->Pass.advance(arena, keepGoing, this->Pixels.output(), requests);
}

} // namespace inr
