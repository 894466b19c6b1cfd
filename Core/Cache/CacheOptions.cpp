// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/CacheOptions.h"

#include "Core/UsableMemory.h"

#include <algorithm>

namespace inr {

std::int64_t DefaultCacheBytes(int processes)
{
  constexpr std::int64_t most = std::int64_t{16} << 30;
  return std::min(UsableMemory() / 4 / processes, most);
}

} // namespace inr
