// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace inr {

/// One of the arrays that a training in progress consists of, where it lies in memory.
struct StateArray
{
  const char* name; ///< at most 8 characters
  void* data;
  std::int64_t bytes;
};

using StateArrays = std::vector<StateArray>;

} // namespace inr
