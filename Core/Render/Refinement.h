// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedPasses.h"
#include "Core/Render/PictureCopy.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/KeptFrame.h"

#include <optional>

namespace inr {

/// A complete picture in the making, over several calls: for views that want more bricks than the
/// cache holds. Whatever is finished is final; the rest shows an earlier, coarser picture.
class Refinement
{
public:
  /// Takes copies of the scene's frame and of `soFar`; what else the scene refers to must outlive
  /// this.
  Refinement(const CachedScene& scene, const PassOutput& soFar);
  Refinement(const Refinement&) = delete;
  Refinement& operator=(const Refinement&) = delete;

  /// Whether `frame` asks for the same picture, and `output` for no more of it.
  bool continues(const Frame& frame, const PassOutput& output) const
  {
    return this->Picture.isOf(frame) && this->Pixels.isEnoughFor(output);
  }

  /// One round of the complete pass; the bricks that it waits for come out of `requests`. Its work.
  WorkDone advance(const Arena& arena, const std::function<bool()>& keepGoing,
                   RequestRanking& requests);
  /// For what it waits for.
  CompletePass& pass() { return this->Pass; }
  bool done() const { return this->Pass.done(); }
  void copyTo(const PassOutput& output) const { this->Pixels.copyTo(output); }
  const FrameStatistics& statistics() const { return this->Pass.statistics(); }

private:
  KeptFrame Picture;
  RayGeometry Geometry;
  std::optional<Shading> Lighting;
  CachedScene Scene;
  CompletePass Pass;
  PictureCopy Pixels;
};

} // namespace inr
