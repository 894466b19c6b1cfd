// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Core/Render/CachedPasses.h"

namespace inr {

/// The pixels of a picture, for a later call that goes on with them.
class PictureCopy
{
public:
  explicit PictureCopy(const PassOutput& from)
      : Rgba(from.rgba),
        Depth(from.depth != nullptr ? *from.depth : Image(from.rgba.width, from.rgba.height, 1)),
        Samples(from.samples != nullptr ? *from.samples
                                        : Image(from.rgba.width, from.rgba.height, 2)),
        HasDepth(from.depth != nullptr), HasSamples(from.samples != nullptr)
  {}

  /// Whether `output` takes no more than the picture had.
  bool isEnoughFor(const PassOutput& output) const
  {
    return (output.depth == nullptr || this->HasDepth) &&
           (output.samples == nullptr || this->HasSamples);
  }
  /// To be written to.

  PassOutput output() { return {this->Rgba, &this->Depth, &this->Samples}; }

  void copyTo(const PassOutput& output) const
  {
    output.rgba = this->Rgba;
    if (output.depth != nullptr) {
      *output.depth = this->Depth;
    }
    if (output.samples != nullptr) {
      *output.samples = this->Samples;
    }
  }

private:
  Image Rgba;
  Image Depth;
  Image Samples;
  bool HasDepth;
  bool HasSamples;
};

} // namespace inr
