// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Kernels/Atomics.h"
#include "CUDA/Render/Kernels/Listed.h"
#include "Core/HostDevice.h"

#include <cstdint>
#include <limits>

namespace inr {
namespace cuda {

/// In which order the rays of a picture are numbered: by the block of 8 x 4 pixels, so that those
/// of a warp stay together; or as a list of pixels has them.
struct RayOrder
{
  static constexpr int BlockWidth = 8;
  static constexpr int BlockHeight = 4;
  static constexpr int BlockSize = BlockWidth * BlockHeight;

  int width; ///< of the picture
  int height;
  const std::uint32_t* pixels; ///< y * width + x; null: blocks
  std::int64_t listed;         ///< of these

  INR_HOST_DEVICE std::int64_t blocksAcross() const
  {
    return (this->width + BlockWidth - 1) / BlockWidth;
  }

  /// Numbers in use; of blocks that reach beyond the picture not all have a pixel.
  INR_HOST_DEVICE std::int64_t rays() const
  {
    const std::int64_t down = (this->height + BlockHeight - 1) / BlockHeight;
    return this->pixels != nullptr ? this->listed : this->blocksAcross() * down * BlockSize;
  }

  /// Of ray number `ray`; -1 where there is none.
  INR_HOST_DEVICE std::int64_t pixel(std::int64_t ray) const
  {
    if (this->pixels != nullptr) {
      return this->pixels[ray];
    }
    const std::int64_t block = ray / BlockSize;
    const auto within = static_cast<int>(ray % BlockSize);
    const std::int64_t x = block % this->blocksAcross() * BlockWidth + within % BlockWidth;
    const std::int64_t y = block / this->blocksAcross() * BlockHeight + within / BlockWidth;
    return x < this->width && y < this->height ? y * this->width + x : -1;
  }
};

/// Rays of a window of a picture, as many as have memory to wait in, and what becomes of them:
/// lists of their numbers in the window, in no order but that of each warp.
struct RayLists
{
  static constexpr int NoLimit = std::numeric_limits<int>::max(); ///< of `most`

  RayOrder order;
  std::int64_t first; ///< number of the window's first ray

  const std::uint32_t* now; ///< those whose turn it is; null: all of the window
  const std::uint64_t* nowCount;
  std::uint64_t* begun; ///< how many of these
  std::uint32_t* later; ///< those that are in for another turn
  std::uint64_t* laterCount;
  std::uint32_t* waiting; ///< those that need bricks
  std::uint64_t* waitingCount;

  int most; ///< steps that a ray may come before it is another one's turn

  /// A ray goes on in another launch: when it has its brick, or when it is its turn. Those of a
  /// warp stay together: they go through the same bricks.
  INR_HOST_DEVICE void list(std::uint32_t ray, bool needsBrick) const
  {
    if (needsBrick) {
      this->waiting[AtomicAddTogether(*this->waitingCount, 1)] = ray;
    } else {
      this->later[AtomicAddTogether(*this->laterCount, 1)] = ray;
    }
  }

  /// Calls function(ray, pixel) for the calling thread's share of those whose turn it is.
  template <class Block, class Function>
  INR_HOST_DEVICE void forEach(Block& block, const Function& function) const
  {
    const auto call = [&](std::uint32_t ray) {
      const std::int64_t pixel = this->order.pixel(this->first + ray);
      if (pixel >= 0) {
        function(ray, pixel);
      }
    };
    ForEachListedInTurn(block, this->now, this->nowCount, this->begun, call);
  }
};

} // namespace cuda
} // namespace inr
