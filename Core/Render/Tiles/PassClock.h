// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Tiles/WorkLimit.h"

#include <atomic>

namespace inr {

/// Whether a pass through tiles goes on, as WorkLimit::secondsForPass says.
class PassClock
{
public:
  PassClock(const WorkLimit& limit, bool hurries) : Limit(limit), Hurries(hurries) {}

  /// To be asked before each tile, on any thread.
  bool mayBegin()
  {
    constexpr int least = 8; // that a call brings, however late it is
    return this->Begun++ < least || this->Limit.secondsForPass(this->Hurries) > 0;
  }

private:
  const WorkLimit& Limit;
  bool Hurries;
  std::atomic<int> Begun{0};
};

} // namespace inr
