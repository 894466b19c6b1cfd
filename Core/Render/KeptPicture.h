// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MarchedTiles.h"
#include "Core/Render/PictureCopy.h"
#include "Core/Render/Scene/KeptFrame.h"

#include <utility>

namespace inr {

/// A picture that is not complete, between two calls.
class KeptPicture
{
public:
  KeptPicture(const Frame& picture, MarchedTiles marched, const PassOutput& output)
      : Picture(picture), Tiles(std::move(marched)), Pixels(output)
  {}

  /// Whether its rays take the same samples, as far as there are bricks. Those of a tolerance are
  /// chosen for the frame, and before they are, it has another scale of its levels.
  bool isOf(const Frame& picture) const { return this->Picture.isOf(picture); }
  /// Whether it shows the same as far as there was time, by other samples: before they were chosen.
  bool isBefore(const Frame& picture) const
  {
    Frame before = picture;
    before.levelOfDetailScale = this->Picture.frame().levelOfDetailScale;
    return picture.errorTolerance && this->Tiles.areReached() && this->Picture.isOf(before);
  }
  /// Whether there is all that `output` takes.
  bool has(const PassOutput& output) const { return this->Pixels.isEnoughFor(output); }
  void copyTo(const PassOutput& output) const { this->Pixels.copyTo(output); }
  /// The tiles, once.
  MarchedTiles take() { return std::move(this->Tiles); }

private:
  KeptFrame Picture;
  MarchedTiles Tiles;
  PictureCopy Pixels;
};

} // namespace inr
