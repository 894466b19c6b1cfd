// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>

namespace inr {

/// Chooses the image resolution of interactive frames from what the last frame cost per pixel, or
/// has always the same where no clock is to decide.
class ImageReduction
{
public:
  explicit ImageReduction(bool measures = true) : Measures(measures) {}

  /// Frames per second below which a frame is a still one; ParaView asks for 0.002 and 5.
  static constexpr double StillRate = 0.1;
  static constexpr int Largest = 8;
  /// Without measurements, and before the first: an interactive frame should come quickly.
  static constexpr int Unmeasured = 4;

  /// The smallest of 1, 2, 4 and 8 by which width and height have to be divided so that a frame of
  /// `pixels` at full resolution takes at most 1/`desiredRate` seconds.
  int factor(double desiredRate, std::int64_t pixels) const
  {
    if (desiredRate < StillRate) {
      return 1;
    }
    if (this->SecondsPerPixel <= 0) {
      return Unmeasured;
    }
    const double full = this->SecondsPerPixel * static_cast<double>(pixels);
    int factor = 1;
    while (factor < Largest && full / (factor * factor) > 1 / desiredRate) {
      factor *= 2;
    }
    return factor;
  }

  void record(double seconds, std::int64_t pixels)
  {
    if (this->Measures) {
      this->SecondsPerPixel = seconds / static_cast<double>(std::max<std::int64_t>(pixels, 1));
    }
  }

private:
  bool Measures;
  double SecondsPerPixel = 0;
};

} // namespace inr
