// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/PictureKey.h"

namespace inr {

PictureKey::PictureKey(const Frame& frame, bool countsSamples, std::int64_t colors)
    : Picture(frame), CountsSamples(countsSamples), Colors(colors)
{}

bool PictureKey::matches(const Frame& frame, bool countsSamples, std::int64_t colors) const
{
  // One made in a limited time may differ by the rounding of values outside their cells' ranges.
  const bool asExact = this->Picture.frame().timeLimit == 0 || frame.timeLimit > 0;
  return asExact && this->CountsSamples == countsSamples && this->Colors == colors &&
         (frame.mode == RenderMode::RayMarching ||
          this->Picture.frame().samplesPerPixel == frame.samplesPerPixel) &&
         this->Picture.isOf(frame);
}

} // namespace inr
