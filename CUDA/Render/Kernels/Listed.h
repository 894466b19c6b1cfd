// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "CUDA/Device/Kernels/Tiles.h"
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

/// The same where some numbers take much longer than others: a warp takes the next ones when it has
/// done with its own. `next`: 0 at the beginning.
template <class Block, class Function>
INR_HOST_DEVICE void ForEachListedInTurn(Block& block, const std::uint32_t* list,
                                         const std::uint64_t* count, std::uint64_t* next,
                                         const Function& function)
{
#ifdef __CUDA_ARCH__
  const std::uint64_t end = *count;
  block.threads([&](int thread) {
    const int lane = thread % WarpSize;
    while (true) {
      __syncwarp(); // numbers side by side are to be done with together
      std::uint64_t first = 0;
      if (lane == 0) {
        first = AtomicAdd(*next, std::uint64_t{WarpSize});
      }
      first = __shfl_sync(~0u, first, 0);
      if (first >= end) {
        break;
      }
      const std::uint64_t k = first + static_cast<std::uint64_t>(lane);
      if (k < end) {
        function(list != nullptr ? list[k] : static_cast<std::uint32_t>(k));
      }
    }
  });
#else
  block.warps([&](const auto& warp) { // the first one takes them all: none waits for another one
    for (std::uint64_t first = AtomicAdd(*next, std::uint64_t{WarpSize}); first < *count;
         first = AtomicAdd(*next, std::uint64_t{WarpSize})) {
      warp.lanes([&](int lane) {
        const std::uint64_t k = first + static_cast<std::uint64_t>(lane);
        if (k < *count) {
          function(list != nullptr ? list[k] : static_cast<std::uint32_t>(k));
        }
      });
    }
  });
#endif
}

} // namespace cuda
} // namespace inr
