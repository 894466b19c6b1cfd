// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace inr {

/// Chooses the image resolution of interactive frames from what the last ones cost, or
/// has always the same where no clock is to decide.
class ImageReduction
{
public:
  /// `first`: without measurements, and before the first.
  explicit ImageReduction(bool measures = true, int first = Unmeasured)
      : Measures(measures), First(first)
  {}

  /// Frames per second below which a frame is a still one; ParaView asks for 0.002 and 5.
  static constexpr double StillRate = 0.1;
  static constexpr int Largest = 64; ///< the last resort: a window is then a few hundred pixels
  /// What a first interactive frame of rays, and one of paths, comes quickly with.
  static constexpr int Unmeasured = 4;
  static constexpr int UnmeasuredPaths = 16;

  /// The smallest of 1, 2, 4 ... 64 by which width and height have to be divided so that a frame of
  /// `pixels` at full resolution is expected to keep to its time.
  int factor(double desiredRate, std::int64_t pixels) const
  {
    if (desiredRate < StillRate) {
      return 1;
    }
    if (this->Pixels <= 0) {
      return this->First;
    }
    const double most = ShareOfFrame / desiredRate;
    int factor = 1;
    while (factor < Largest) {
      if (this->expected(static_cast<double>(pixels) / (factor * factor)) <= most) {
        break;
      }
      factor *= 2;
    }
    return factor;
  }

  /// That a picture of so many pixels took so many seconds. What is slower than was expected is
  /// believed at once, what is faster by and by: a resolution that comes and goes disturbs.
  void record(double seconds, std::int64_t pixels)
  {
    if (this->Measures && pixels > 0) {
      const auto size = static_cast<double>(pixels);
      const double known = this->Pixels > 0 ? this->expected(size) : seconds;
      this->Seconds = std::max(seconds, 0.5 * (seconds + known));
      this->Pixels = size;
    }
  }

private:
  /// Of the time between two frames; the rest is for bricks that are loaded, and the host.
  static constexpr double ShareOfFrame = 0.75;

  /// Seconds for a picture of so many pixels. Finer ones see finer levels, so that their rays take
  /// more samples, too.
  double expected(double pixels) const
  {
    const double ratio = pixels / this->Pixels;
    return this->Seconds * ratio * std::sqrt(std::max(ratio, 1.0));
  }

  bool Measures;
  int First;
  double Seconds = 0;
  double Pixels = 0; ///< 0 before anything was measured
};

} // namespace inr
