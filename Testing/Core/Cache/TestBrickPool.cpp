// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickPool.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace test::brick_pool {

constexpr std::int64_t Voxels = 343;

std::vector<float> RandomBrick(float low, float high)
{
  std::vector<float> values(Voxels);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = low + (high - low) * inr::RandomUnit(3, k);
  }
  values[5] = low;
  values[6] = high;
  return values;
}

float Stored(const inr::BrickPool& pool, std::int32_t slot, std::int64_t voxel)
{
  const inr::BrickView view = pool.view(slot);
  switch (pool.precision()) {
  case inr::CachePrecision::Float32:
    return static_cast<const float*>(view.voxels)[voxel];
  case inr::CachePrecision::Bits16:
    return view.low + view.step * static_cast<const std::uint16_t*>(view.voxels)[voxel];
  default:
    return view.low + view.step * static_cast<const std::uint8_t*>(view.voxels)[voxel];
  }
}

float LargestError(inr::CachePrecision precision, const std::vector<float>& values)
{
  inr::BrickPool pool(precision, Voxels, 3);
  pool.resize(3);
  pool.store(1, values.data());
  float largest = 0;
  for (std::int64_t k = 0; k < Voxels; ++k) {
    largest = std::max(largest, std::abs(Stored(pool, 1, k) - values[static_cast<std::size_t>(k)]));
  }
  return largest;
}

TEST(BrickPool, IsOffByHalfAQuantumAtMost)
{
  const std::vector<float> values = RandomBrick(0.25f, 0.75f);
  EXPECT_EQ(LargestError(inr::CachePrecision::Float32, values), 0.0f);
  // And a few units in the last place of the arithmetic.
  EXPECT_LE(LargestError(inr::CachePrecision::Bits16, values), 0.5f / 65535 / 2 + 2e-7f);
  EXPECT_LE(LargestError(inr::CachePrecision::Bits8, values), 0.5f / 255 / 2 + 2e-7f);
  EXPECT_GT(LargestError(inr::CachePrecision::Bits8, values), 0.5f / 255 / 4);
}

// So that what is known of a brick changes no voxel of it.
TEST(BrickPool, DividesTheRangeThatItIsGivenWhateverTheValues)
{
  for (const auto precision : {inr::CachePrecision::Bits16, inr::CachePrecision::Bits8}) {
    const float quanta = precision == inr::CachePrecision::Bits16 ? 65535 : 255;
    std::vector<float> values = RandomBrick(0.4f, 0.6f);
    values[7] = 0.1f;
    values[8] = 0.9f;
    inr::BrickPool pool(precision, Voxels, 1);
    pool.resize(1);
    pool.store(0, values.data(), {0.25f, 0.75f});
    EXPECT_EQ(pool.view(0).low, 0.25f);
    EXPECT_EQ(pool.view(0).step, 0.5f / quanta);
    EXPECT_EQ(Stored(pool, 0, 7), 0.25f);
    EXPECT_NEAR(Stored(pool, 0, 8), 0.75f, 1e-6f);
    EXPECT_NEAR(Stored(pool, 0, 9), values[9], 0.5f / quanta / 2 + 2e-7f);
  }
}

TEST(BrickPool, KeepsAConstantBrickExactly)
{
  const std::vector<float> values(Voxels, 0.3f);
  EXPECT_EQ(LargestError(inr::CachePrecision::Bits16, values), 0.0f);
  EXPECT_EQ(LargestError(inr::CachePrecision::Bits8, values), 0.0f);
}

// Of which a quantum is too small for its inverse to be a float.
TEST(BrickPool, KeepsRangesThatAreHardlyThere)
{
  for (const float high : {1e-44f, 1e-40f, 3e-38f, 1e-36f, 1e-34f}) {
    const std::vector<float> values = RandomBrick(0.0f, high);
    const float smallest = std::numeric_limits<float>::min();
    for (const auto precision : {inr::CachePrecision::Bits16, inr::CachePrecision::Bits8}) {
      const float quanta = precision == inr::CachePrecision::Bits16 ? 65535 : 255;
      const float quantum = std::max(high / quanta, smallest);
      EXPECT_LE(LargestError(precision, values), 0.5f * quantum + 1e-5f * high) << high;
    }
  }
}

// Whole vectors of voxels and what remains of them, with the extremes anywhere.
TEST(BrickPool, FindsTheRangeOfAnyNumberOfVoxels)
{
  for (std::int64_t count = 1; count < 70; ++count) {
    for (std::int64_t at = 0; at < count; ++at) {
      std::vector<float> values(static_cast<std::size_t>(count), 0.5f);
      values[static_cast<std::size_t>(at)] = 0.875f;
      values[static_cast<std::size_t>((at + 1) % count)] = count > 1 ? 0.125f : 0.875f;
      inr::BrickPool pool(inr::CachePrecision::Bits8, count, 1);
      pool.resize(1);
      pool.store(0, values.data());
      for (std::int64_t k = 0; k < count; ++k) {
        ASSERT_NEAR(Stored(pool, 0, k), values[static_cast<std::size_t>(k)],
                    0.75f / 255 / 2 + 1e-6f);
      }
    }
  }
}

TEST(BrickPool, SlotsAreApart)
{
  for (const auto precision : {inr::CachePrecision::Float32, inr::CachePrecision::Bits8}) {
    inr::BrickPool pool(precision, Voxels, 3);
    pool.resize(3);
    pool.store(0, RandomBrick(0, 0.1f).data());
    pool.store(2, RandomBrick(0.2f, 0.3f).data());
    pool.store(1, RandomBrick(0.8f, 1).data());
    EXPECT_LE(Stored(pool, 0, Voxels - 1), 0.1f);
    EXPECT_GE(Stored(pool, 2, 0), 0.2f);
    EXPECT_LE(Stored(pool, 2, 0), 0.3f);
  }
}

} // namespace test::brick_pool
