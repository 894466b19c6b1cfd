// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Timer.h"

#include <algorithm>
#include <limits>

namespace inr {

/// How much of the work that a frame waits for is done before it is handed over as it is: what
/// there is time for or, counted, always the same.
///
/// This is where a clock decides what a picture shows:
/// - whether rays are marched once more through the bricks that have come in meanwhile,
/// - how many bricks are loaded within a frame, and how far one gets that wants more of them than
///   the cache holds,
/// - whether the field is measured further for an error tolerance,
/// - through how many tiles rays or paths go, where all of them take twice as long as there is, one
///   path is there everywhere, or the network is asked what paths meet,
/// - how many rounds of paths are traced or, by an accelerator whose cache is too small, how far
///   they get.
/// Counted, it is one pass, CacheOptions::maximumRequests bricks at most (so many for each pass
/// that brings rays no further), and one round through all tiles that are not finished.
///
/// Outside of it are the loader, whose threads go on between frames unless CacheOptions::background
/// is off, and the host: when it asks for a frame, at what size, and whether it stops one.
class WorkLimit
{
public:
  /// Of a frame that begins now; `seconds` as Frame::timeLimit, `sharedBy` as there.
  WorkLimit(double seconds, bool counted, int sharedBy = 1)
      : Clock(seconds / sharedBy), Seconds(seconds / sharedBy), Least(0.25 / sharedBy),
        Counted(counted)
  {}

  bool isLimited() const { return this->Seconds > 0; }
  bool isTimed() const { return this->isLimited() && !this->Counted; }
  /// Whether the frame ends before another round that may take so many seconds.
  bool endsWithin(double seconds) const
  {
    return this->isLimited() && (this->Counted || this->Clock.left() < seconds);
  }
  /// Until a pass through tiles has to end in its midst: where it `hurries`, with the frame, else a
  /// good while later, as a picture with all of its pixels is worth some time.
  double secondsForPass(bool hurries) const
  {
    constexpr double patience = 2; // times the limit
    if (!this->isTimed()) {
      return std::numeric_limits<double>::infinity();
    }
    return hurries ? this->Clock.left()
                   : std::max(patience * this->Seconds, this->Least) - this->Clock.seconds();
  }
  /// Where it is timed: what is left, but at least a part of the limit and of what the frame has
  /// taken so far. However long rendering itself takes, part/(1 + part) of all the time is for what
  /// it waits for.
  double secondsForLoading(double part = 0.25) const
  {
    return std::max(this->Clock.left(), part * std::max(this->Seconds, this->Clock.seconds()));
  }

private:
  Timer Clock;
  double Seconds;
  double Least; ///< for a pass through all pixels
  bool Counted;
};

} // namespace inr
