// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Calls function(number) for the calling thread's share of the numbers in a list, which a launch
/// before has made; of a null one these are 0, 1 and so on. `threads`: of a block.
template <class Block, class Function>
INR_HOST_DEVICE void ForEachListed(Block& block, int threads, const std::uint32_t* list,
                                   const std::uint64_t* count, const Function& function)
{
  const auto end = static_cast<std::int64_t>(*count);
  block.threads([&](int thread) {
    const std::int64_t step = std::int64_t{block.count()} * threads;
    for (std::int64_t k = std::int64_t{block.index()} * threads + thread; k < end; k += step) {
      function(list != nullptr ? list[k] : static_cast<std::uint32_t>(k));
    }
  });
}

} // namespace cuda
} // namespace inr
