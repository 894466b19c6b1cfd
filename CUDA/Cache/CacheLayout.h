// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/CachePrecision.h"
#include "Core/Cache/Hierarchy.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// How many of what a cache in a device's memory has.
struct CacheLayout
{
  static constexpr std::int64_t BytesBehind = 64; ///< the last voxel, for loads of several

  std::int64_t capacity; ///< bricks
  std::int64_t atOnce;   ///< bricks that are inferred by one launch
  std::int64_t requests; ///< entries of their table, a power of two
  std::int64_t pages;    ///< entries of the page table, a power of two
  std::int64_t cells;    ///< macro-cells by whose ranges values are divided
  std::int64_t bytes;    ///< of everything
};

/// What a cache has however few bricks it holds.
struct CacheNeeds
{
  std::int64_t inference = 0; ///< bytes
  std::int64_t cells = 0;     ///< see CacheLayout
};

/// The largest cache within so many bytes: pool, tables, what ranks, and what loads, `needs`
/// included. Throws Error(InvalidArgument) with figures when that does not hold
/// BrickCache::FewestBricks.
CacheLayout LayOutCache(const Hierarchy& hierarchy, CachePrecision precision, std::int64_t bytes,
                        const CacheNeeds& needs);

/// The bytes of the smallest one.
std::int64_t LeastCacheBytes(const Hierarchy& hierarchy, CachePrecision precision,
                             const CacheNeeds& needs);

} // namespace cuda
} // namespace inr
