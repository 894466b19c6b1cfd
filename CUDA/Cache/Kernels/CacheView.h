// SPDX-License-Identifier: BSD-3-Clause
//
// A cache of bricks in a device's memory, as kernels see it.
#pragma once

#include "CUDA/Cache/Kernels/RequestTable.h"
#include "Core/Cache/BrickView.h"
#include "Core/Cache/CachePrecision.h"
#include "Core/Cache/HierarchyView.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Where a brick is; as wide as one load.
struct alignas(16) PageEntry
{
  BrickKey key;      ///< NoBrick where it is free
  std::int64_t slot; ///< -1 there
};

/// value = low + step * stored.
struct BrickScale
{
  float low;
  float step;
};

/// Plain data, passed to kernels by value. Of what all threads of a frame share they change, by
/// touch and request, only what none of them reads; what is mapped changes between frames.
struct CacheView
{
  static constexpr std::int32_t Unmapped = -1;

  HierarchyView hierarchy; ///< its levels lie in the device's memory
  CachePrecision precision;
  std::int64_t bytesPerBrick;
  std::int64_t rowStride;   ///< voxels of a brick from one to the next along y
  std::int64_t layerStride; ///< and along z; 1 along x

  std::uint64_t frame;   ///< the present one, from 1 on
  std::int64_t capacity; ///< slots

  /// Open addressing, linear probing, at most half full, so that every search ends. Its memory
  /// follows what can be mapped, not the volume.
  PageEntry* pages;
  std::uint32_t pageMask; ///< their number, a power of two, less one

  unsigned char* voxels; ///< of all slots; readable for 64 bytes behind the last
  BrickScale* scales;    ///< of each slot
  BrickKey* owners;      ///< of each slot that has been used
  std::uint64_t* uses;   ///< frame in which each slot was last used; 0: it is free

  RequestTable requests;

  /// Slot of a brick, or Unmapped.
  INR_HOST_DEVICE std::int32_t find(BrickKey key) const
  {
    auto place = static_cast<std::uint32_t>(MixBits(key)) & this->pageMask;
    for (;; place = (place + 1) & this->pageMask) {
      const PageEntry entry = this->pages[place];
      if (entry.key == key || entry.key == NoBrick) {
        return static_cast<std::int32_t>(entry.slot);
      }
    }
  }

  INR_HOST_DEVICE BrickView view(std::int32_t slot) const
  {
    const BrickScale scale = this->scales[slot];
    return {this->voxels + slot * this->bytesPerBrick, scale.low, scale.step};
  }

  /// Marks a mapped brick as used in this frame: the next ones to come in do not take its place.
  INR_HOST_DEVICE void touch(std::int32_t slot) const
  {
    if (this->uses[slot] != this->frame) { // most touches repeat an earlier one
      this->uses[slot] = this->frame;
    }
  }

  /// A wish for a brick of the hierarchy that is not mapped. `contribution`: as in Core's Request,
  /// at most RequestTable::MostPerWish of it counts.
  INR_HOST_DEVICE void request(BrickKey key, float contribution) const
  {
    this->requests.add(key, contribution);
  }
};

} // namespace cuda
} // namespace inr
