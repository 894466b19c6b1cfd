// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickPool.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

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

TEST(BrickPool, KeepsAConstantBrickExactly)
{
  const std::vector<float> values(Voxels, 0.3f);
  EXPECT_EQ(LargestError(inr::CachePrecision::Bits16, values), 0.0f);
  EXPECT_EQ(LargestError(inr::CachePrecision::Bits8, values), 0.0f);
}

TEST(BrickPool, SlotsAreApart)
{
  for (const auto precision : {inr::CachePrecision::Float32, inr::CachePrecision::Bits8}) {
    inr::BrickPool pool(precision, Voxels, 3);
    pool.store(0, RandomBrick(0, 0.1f).data());
    pool.store(2, RandomBrick(0.2f, 0.3f).data());
    pool.store(1, RandomBrick(0.8f, 1).data());
    EXPECT_LE(Stored(pool, 0, Voxels - 1), 0.1f);
    EXPECT_GE(Stored(pool, 2, 0), 0.2f);
    EXPECT_LE(Stored(pool, 2, 0), 0.3f);
  }
}

} // namespace
