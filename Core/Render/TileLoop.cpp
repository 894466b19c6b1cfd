// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/TileLoop.h"

#include "Core/Error.h"
#include "Core/Parallel.h"

#include <atomic>

namespace inr {

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
    throw Error(ErrorCode::Cancelled, "rendering stopped on request");
  }
}

} // namespace inr
