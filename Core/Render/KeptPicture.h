// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/KeptFrame.h"
#include "Core/Render/MarchedTiles.h"
#include "Core/Render/PictureCopy.h"

#include <utility>

namespace inr {

/// A picture that lacks bricks, between two calls.
struct KeptPicture
{
  KeptPicture(const Frame& picture, MarchedTiles marched, const PassOutput& output)
      : frame(picture), tiles(std::move(marched)), pixels(output)
  {}

  bool isOf(const Frame& picture, const PassOutput& output) const
  {
    return this->frame.isOf(picture) && this->pixels.isEnoughFor(output);
  }

  KeptFrame frame;
  MarchedTiles tiles;
  PictureCopy pixels;
};

} // namespace inr
