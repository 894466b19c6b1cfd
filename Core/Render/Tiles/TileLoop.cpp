// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tiles/TileLoop.h"

#include "Core/Error.h"
#include "Core/Parallel.h"

#include <atomic>

namespace inr {

namespace {

[[noreturn]] void Stop() { throw Error(ErrorCode::Cancelled, "rendering stopped on request"); }

} // namespace

void RequireGoing(const std::function<bool()>& keepGoing)
{
  if (keepGoing && !keepGoing()) {
    Stop();
  }
}

void ForEachTile(const Arena& arena, std::int64_t count, const std::function<bool()>& keepGoing,
                 const std::function<void(std::int64_t)>& body)
{
  std::atomic<bool> stopped{false};
  arena.forEachBlock(count, 1, [&](std::int64_t k, std::int64_t) {
    if (stopped || (keepGoing && !keepGoing())) {
      stopped = true;
      return;
    }
    body(k);
  });
  if (stopped) {
    Stop();
  }
}

} // namespace inr
