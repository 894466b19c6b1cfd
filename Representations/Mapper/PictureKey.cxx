// SPDX-License-Identifier: BSD-3-Clause
#include "PictureKey.h"

namespace inr {

PictureKey::PictureKey(const Frame& frame, bool countsSamples, std::int64_t colors)
    : OpaqueDepth(CopyOfDepth(frame)), Picture(frame), CountsSamples(countsSamples), Colors(colors)
{
  this->Picture.opaqueDepth = this->OpaqueDepth.empty() ? nullptr : this->OpaqueDepth.data();
}

bool PictureKey::matches(const Frame& frame, bool countsSamples, std::int64_t colors) const
{
  // One made in a limited time may differ by the rounding of values outside their cells' ranges.
  const bool asExact = this->Picture.timeLimit == 0 || frame.timeLimit > 0;
  return asExact && this->CountsSamples == countsSamples && this->Colors == colors &&
         (frame.mode == RenderMode::RayMarching ||
          this->Picture.samplesPerPixel == frame.samplesPerPixel) &&
         IsSamePicture(this->Picture, frame);
}

} // namespace inr
