// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/Frame.h"

#include "Core/Render/Scene/SameBits.h"

namespace inr {

namespace {

bool HaveSameDepth(const Frame& a, const Frame& b)
{
  if (a.opaqueDepth == nullptr || b.opaqueDepth == nullptr) {
    return a.opaqueDepth == b.opaqueDepth;
  }
  const auto pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
  return HaveSameBits(a.opaqueDepth, b.opaqueDepth, pixels);
}

bool IsSame(const std::shared_ptr<const TranslucentLayers>& a,
            const std::shared_ptr<const TranslucentLayers>& b)
{
  return a == b || (a && b && a->layers == b->layers);
}

} // namespace

std::vector<float> CopyOfDepth(const Frame& frame)
{
  if (frame.opaqueDepth == nullptr) {
    return {};
  }
  const auto pixels = static_cast<std::ptrdiff_t>(frame.width) * frame.height;
  return {frame.opaqueDepth, frame.opaqueDepth + pixels};
}

bool IsSamePicture(const Frame& a, const Frame& b)
{
  return a.width == b.width && a.height == b.height && a.clipToWorld == b.clipToWorld &&
         a.worldToIndex == b.worldToIndex && a.clippingPlanes == b.clippingPlanes &&
         a.piece == b.piece && a.cropping == b.cropping && a.lights == b.lights &&
         a.shading == b.shading && a.mode == b.mode && a.paths == b.paths &&
         a.blending == b.blending && a.unitDistance == b.unitDistance &&
         a.worldToMedium == b.worldToMedium && a.sampleDistance == b.sampleDistance &&
         a.adaptiveSampling == b.adaptiveSampling && a.preIntegration == b.preIntegration &&
         a.levelOfDetailScale == b.levelOfDetailScale && a.errorTolerance == b.errorTolerance &&
         a.seed == b.seed && a.frameIndex == b.frameIndex && HaveSameDepth(a, b) &&
         IsSame(a.layers, b.layers);
}

} // namespace inr
