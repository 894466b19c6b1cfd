// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/MarchedTiles.h"
#include "Core/Render/PictureCopy.h"
#include "Core/Render/Scene/KeptFrame.h"

#include <optional>
#include <utility>

namespace inr {

/// A picture that lacks bricks, between two calls.
class KeptPicture
{
public:
  /// Of which nothing is kept but what was asked for: a view that moves asks for no picture twice.
  explicit KeptPicture(const Frame& picture) : Picture(picture) {}
  /// And how far it is.
  KeptPicture(const Frame& picture, MarchedTiles marched, const PassOutput& output)
      : Picture(picture), Tiles(std::move(marched)), Pixels(output)
  {}

  bool isOf(const Frame& picture) const { return this->Picture.isOf(picture); }
  /// Whether there is all that `output` takes.
  bool has(const PassOutput& output) const
  {
    return this->Pixels && this->Pixels->isEnoughFor(output);
  }
  /// That, once: the pixels to `output`, and the tiles.
  MarchedTiles take(const PassOutput& output)
  {
    this->Pixels->copyTo(output);
    return std::move(*this->Tiles);
  }

private:
  KeptFrame Picture;
  std::optional<MarchedTiles> Tiles;
  std::optional<PictureCopy> Pixels;
};

} // namespace inr
