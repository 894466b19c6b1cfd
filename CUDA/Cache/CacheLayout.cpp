// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/CacheLayout.h"

#include "CUDA/Cache/Kernels/ListBricks.h"
#include "Core/Cache/BrickCache.h"

#include <algorithm>

namespace inr {
namespace cuda {

namespace {

constexpr std::int64_t FewestRequests = RequestTable::MostProbes;
constexpr std::int64_t MostRequests = 1 << 18; ///< bricks that a picture of any size may miss
constexpr std::int64_t MostSlots = std::int64_t{1} << 30;

template <class T> std::int64_t BytesOf(std::int64_t count)
{
  return count * static_cast<std::int64_t>(sizeof(T));
}

std::int64_t PowerOfTwoFrom(std::int64_t least)
{
  std::int64_t power = 1;
  while (power < least) {
    power *= 2;
  }
  return power;
}

/// Of the whole volume, beyond which slots would stay empty.
std::int64_t BricksOf(const Hierarchy& hierarchy)
{
  std::int64_t bricks = 0;
  for (int level = 0; level < hierarchy.levels() && bricks < MostSlots; ++level) {
    const glm::i64vec3& count = hierarchy.bricks(level);
    const std::int64_t layer = std::min(count.x * count.y, MostSlots);
    bricks += std::min(layer * count.z, MostSlots);
  }
  return std::clamp(bricks, BrickCache::FewestBricks, MostSlots);
}

class Planner
{
public:
  Planner(const Hierarchy& hierarchy, CachePrecision precision, const CacheNeeds& needs)
      : Levels(hierarchy), Precision(precision), Needs(needs)
  {}

  CacheLayout plan(std::int64_t capacity, std::int64_t atOnce, std::int64_t requests) const
  {
    CacheLayout layout{};
    layout.capacity = capacity;
    layout.atOnce = atOnce;
    layout.requests = requests;
    layout.pages = PowerOfTwoFrom(2 * capacity);
    layout.cells = this->Needs.cells;
    layout.bytes = this->bytesOf(layout);
    return layout;
  }

  /// The largest that fits; of fewer bricks than it must have where none does.
  CacheLayout fit(std::int64_t bytes, std::int64_t atOnce, std::int64_t requests) const
  {
    std::int64_t low = 0;
    for (std::int64_t high = BricksOf(this->Levels); low < high;) {
      const std::int64_t middle = high - (high - low) / 2;
      if (this->plan(middle, atOnce, requests).bytes <= bytes) {
        low = middle;
      } else {
        high = middle - 1;
      }
    }
    return this->plan(low, atOnce, requests);
  }

private:
  std::int64_t bytesOf(const CacheLayout& layout) const
  {
    const std::int64_t voxels = this->Levels.voxelsPerBrick();
    const std::int64_t pool =
        layout.capacity * voxels * BytesPerVoxel(this->Precision) + CacheLayout::BytesBehind;
    const std::int64_t slots = BytesOf<BrickScale>(layout.capacity) +
                               BytesOf<BrickKey>(layout.capacity) +
                               BytesOf<std::uint64_t>(layout.capacity);
    const std::int64_t tables = BytesOf<PageEntry>(layout.pages) +
                                BytesOf<RequestEntry>(layout.requests) +
                                BytesOf<HierarchyLevel>(this->Levels.levels());
    const std::int64_t ranking =
        SelectionBytes(std::max(layout.capacity, layout.requests), layout.atOnce) +
        BytesOf<RankEntry>(2 * layout.atOnce) + BytesOf<CacheCounts>(1);
    const std::int64_t loading = BytesOf<BrickJob>(layout.atOnce) +
                                 BytesOf<std::uint32_t>(layout.atOnce) +
                                 BytesOf<float>(layout.atOnce * voxels) +
                                 BytesOf<ValueRange>(layout.cells) + this->Needs.inference;
    return pool + slots + tables + ranking + loading;
  }

  const Hierarchy& Levels;
  CachePrecision Precision;
  CacheNeeds Needs;
};

} // namespace

CacheLayout LayOutCache(const Hierarchy& hierarchy, CachePrecision precision, std::int64_t bytes,
                        const CacheNeeds& needs)
{
  // Launches of 16 MiB of voxels have work for every multiprocessor; an eighth of a small budget.
  const std::int64_t brick = hierarchy.voxelsPerBrick() * static_cast<std::int64_t>(sizeof(float));
  const std::int64_t buffer = std::min<std::int64_t>(bytes / 8, 16 << 20);
  const std::int64_t atOnce = std::clamp<std::int64_t>(buffer / brick, 1, MostSelected);
  const std::int64_t wishes =
      std::clamp(bytes / 64 / BytesOf<RequestEntry>(1), FewestRequests, MostRequests);
  const std::int64_t requests = PowerOfTwoFrom(wishes / 2 + 1);
  const Planner planner(hierarchy, precision, needs);
  const CacheLayout usual = planner.fit(bytes, atOnce, requests);
  if (usual.capacity >= BrickCache::FewestBricks) {
    return usual;
  }
  const CacheLayout smallest = planner.fit(bytes, 1, FewestRequests);
  if (smallest.capacity < BrickCache::FewestBricks) {
    BrickCache::refuse(hierarchy, "on the GPU ", bytes,
                       LeastCacheBytes(hierarchy, precision, needs));
  }
  return smallest;
}

std::int64_t LeastCacheBytes(const Hierarchy& hierarchy, CachePrecision precision,
                             const CacheNeeds& needs)
{
  return Planner(hierarchy, precision, needs)
      .plan(BrickCache::FewestBricks, 1, FewestRequests)
      .bytes;
}

} // namespace cuda
} // namespace inr
