// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/Blending/CachedPasses.h"

#include <optional>

namespace inr {

/// The pixels of a picture, for a later call that goes on with them.
class PictureCopy
{
public:
  explicit PictureCopy(const PassOutput& from) : Rgba(from.rgba)
  {
    if (from.depth != nullptr) {
      this->Depth = *from.depth;
    }
    if (from.samples != nullptr) {
      this->Samples = *from.samples;
    }
  }

  /// Whether `output` takes no more than there is.
  bool isEnoughFor(const PassOutput& output) const
  {
    return (output.depth == nullptr || this->Depth) && (output.samples == nullptr || this->Samples);
  }
  void copyTo(const PassOutput& output) const
  {
    output.rgba = this->Rgba;
    if (output.depth != nullptr) {
      *output.depth = *this->Depth;
    }
    if (output.samples != nullptr) {
      *output.samples = *this->Samples;
    }
  }

  /// To be written to.
  PassOutput output()
  {
    return {this->Rgba, this->Depth ? &*this->Depth : nullptr,
            this->Samples ? &*this->Samples : nullptr};
  }

private:
  Image Rgba;
  std::optional<Image> Depth;
  std::optional<Image> Samples;
};

} // namespace inr
