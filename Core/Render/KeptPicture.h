// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/CachedScene.h"
#include "Core/Render/MarchedTiles.h"
#include "Core/Render/PictureCopy.h"
#include "Core/Render/Scene/KeptFrame.h"

#include <utility>

namespace inr {

/// A picture that is not complete, between two calls.
class KeptPicture
{
public:
  KeptPicture(const CachedScene& scene, MarchedTiles marched, const PassOutput& output)
      : Picture(scene.frame), SamplesChosen(AreSamplesChosen(scene)), Tiles(std::move(marched)),
        Pixels(output)
  {}

  /// Whether its rays take the same samples, as far as there are bricks.
  bool isOf(const CachedScene& scene) const
  {
    return this->SamplesChosen == AreSamplesChosen(scene) && this->Picture.isOf(scene.frame);
  }
  /// Whether there is all that `output` takes.
  bool has(const PassOutput& output) const { return this->Pixels.isEnoughFor(output); }
  /// That, once: the pixels to `output`, and the tiles.
  MarchedTiles take(const PassOutput& output)
  {
    this->Pixels.copyTo(output);
    return std::move(this->Tiles);
  }

private:
  /// For a tolerance: there is one choice for each frame, and none until the field is measured.
  static bool AreSamplesChosen(const CachedScene& scene)
  {
    return scene.settings.cellSampling != nullptr;
  }

  KeptFrame Picture;
  bool SamplesChosen;
  MarchedTiles Tiles;
  PictureCopy Pixels;
};

} // namespace inr
