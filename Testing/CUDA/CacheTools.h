// SPDX-License-Identifier: BSD-3-Clause
//
// For tests of a DeviceCache on the host.
#pragma once

#include "CUDA/Cache/CacheLayout.h"
#include "Core/Cache/BrickPool.h"
#include "Core/Random.h"
#include "Testing/CUDA/AskFor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

constexpr inr::CachePrecision AllPrecisions[] = {
    inr::CachePrecision::Float32, inr::CachePrecision::Bits16, inr::CachePrecision::Bits8};

inline inr::BrickKey AnyBrick(const inr::Hierarchy& levels, std::uint64_t seed)
{
  const auto draw = [&](std::uint64_t counter, std::int64_t count) {
    return static_cast<std::int64_t>(inr::RandomBits(seed, counter) %
                                     static_cast<std::uint64_t>(count));
  };
  const auto level = static_cast<int>(draw(0, levels.levels()));
  const glm::i64vec3& bricks = levels.bricks(level);
  return inr::KeyOf({level, {draw(1, bricks.x), draw(2, bricks.y), draw(3, bricks.z)}});
}

/// Different ones, the coarsest not among them.
inline std::vector<inr::BrickKey> DifferentBricks(const inr::Hierarchy& levels, std::size_t count)
{
  std::vector<inr::BrickKey> keys;
  for (std::uint64_t seed = 0; keys.size() < count; ++seed) {
    const inr::BrickKey key = AnyBrick(levels, seed);
    if (key != levels.coarsest() && std::find(keys.begin(), keys.end(), key) == keys.end()) {
      keys.push_back(key);
    }
  }
  return keys;
}

inline std::vector<Wish> WishesFor(const std::vector<inr::BrickKey>& keys)
{
  std::vector<Wish> wishes;
  wishes.reserve(keys.size());
  for (const inr::BrickKey key : keys) {
    wishes.push_back({key, 1.0f});
  }
  return wishes;
}

/// What a slot holds is what Core's pool makes of the voxels of a brick in cells `within` a range.
inline void ExpectStored(const inr::BrickView& view, const inr::Hierarchy& levels,
                         inr::CachePrecision precision, const std::vector<float>& values,
                         const inr::ValueRange& within = {})
{
  inr::BrickPool pool(precision, levels.voxelsPerBrick(), 1);
  pool.resize(1);
  pool.store(0, values.data(), within);
  const inr::BrickView expected = pool.view(0);
  EXPECT_EQ(view.low, expected.low);
  EXPECT_FALSE(std::signbit(view.low)); // which of two zeros Core's is, depends on their order
  EXPECT_EQ(view.step, expected.step);
  const auto bytes =
      static_cast<std::size_t>(levels.voxelsPerBrick() * inr::BytesPerVoxel(precision));
  EXPECT_EQ(std::memcmp(view.voxels, expected.voxels, bytes), 0);
}

/// That hold so many bricks, or few more.
inline std::int64_t BytesFor(const inr::Hierarchy& levels, inr::CachePrecision precision,
                             std::int64_t bricks)
{
  std::int64_t bytes = 14 << 10;
  while (inr::cuda::LayOutCache(levels, precision, bytes, {}).capacity < bricks) {
    bytes += 1 << 10;
  }
  return bytes;
}
