// SPDX-License-Identifier: BSD-3-Clause
//
// The imitation of the tile unit itself: what Intel's manual says of LDTILECFG, TILELOADD,
// TILESTORED and TDPBF16PS.
#include "Core/Random.h"
#include "Testing/Core/Inference/TileImitation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

namespace test::tile_unit {

using imitation::TileFault;

/// A number that is one of bfloat16, as the upper half of a float.
std::uint32_t HalfOf(float value)
{
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof(bits));
  EXPECT_EQ(bits & 0xffffu, 0u) << value << " is no bfloat16 number";
  return bits >> 16;
}

std::uint32_t PairOf(float lower, float upper) { return HalfOf(lower) | HalfOf(upper) << 16; }

/// The sum in one element of `before` and products of pairs.
float SumOf(float before, const std::vector<std::pair<float, float>>& lower,
            const std::vector<std::pair<float, float>>& upper = {})
{
  std::uint32_t factors[2][16] = {};
  for (std::size_t k = 0; k < lower.size(); ++k) {
    const auto second = k < upper.size() ? upper[k] : std::pair{0.0f, 0.0f};
    factors[0][k] = PairOf(lower[k].first, second.first);
    factors[1][k] = PairOf(lower[k].second, second.second);
  }
  inr::TileShapes shapes{};
  shapes.palette = 1;
  shapes.rows[0] = shapes.rows[1] = 1;
  shapes.rows[2] = 16;
  shapes.bytesPerRow[0] = shapes.bytesPerRow[2] = 4;
  shapes.bytesPerRow[1] = 64;
  imitation::Configure(shapes);
  imitation::Load(0, &before, 4);
  imitation::Load(1, factors[0], 64);
  imitation::Load(2, factors[1], 4); // a column
  imitation::MultiplyAdd(0, 1, 2);
  float sum = 0;
  imitation::Store(0, &sum, 4);
  imitation::Release();
  return sum;
}

TEST(TileUnit, AddsUpLowerAndUpperHalvesByThemselves)
{
  const float large = 0x1p25f; // above which 1 is lost
  EXPECT_EQ(SumOf(0, {{1, 1}, {2, 3}}, {{4, 5}, {1, 1}}), 28.0f);
  EXPECT_EQ(SumOf(0, {{large, 1}, {1, 1}, {-large, 1}}), 0.0f);
  EXPECT_EQ(SumOf(0, {{large, 1}, {-large, 1}}, {{1, 1}, {0, 0}}), 1.0f);
  EXPECT_EQ(SumOf(large, {{1, 1}}, {{-large, 1}}), 0.0f); // both before what was there
  EXPECT_EQ(SumOf(1, {{large, 1}}, {{-large, 1}}), 1.0f);
}

TEST(TileUnit, RoundsOnceToNearestAndEven)
{
  const float step = 0x1p-7f;                         // of bfloat16 from 1 on
  EXPECT_EQ(SumOf(0, {{1, 1}, {0x1p-24f, 1}}), 1.0f); // half way to the next float
  EXPECT_EQ(SumOf(0, {{1 + step, 1}, {0x1p-23f, 1}}), 1 + step + 0x1p-23f);
  EXPECT_EQ(SumOf(1 + 0x1p-23f, {{0x1p-24f, 1}}), 1 + 0x1p-22f); // to the even one
  // A product has 16 digits: with 1 they are 25, and the last one decides.
  EXPECT_EQ(SumOf(0, {{1, 1}, {0x1p-12f + 0x1p-19f, 0x1p-12f + 0x1p-19f}}), 1 + 0x1p-23f);
}

TEST(TileUnit, TakesDenormalNumbersForZero)
{
  EXPECT_EQ(SumOf(0, {{0x1p-127f, 0x1p100f}}), 0.0f); // what goes in
  EXPECT_EQ(SumOf(0x1p-140f, {{0, 0}}), 0.0f);
  EXPECT_EQ(SumOf(0, {{0x1p-64f, 0x1p-63f}}), 0.0f); // what comes out
  EXPECT_EQ(SumOf(0, {{0x1p-63f, 0x1p-63f}}), 0x1p-126f);
  EXPECT_EQ(SumOf(0, {{0x1p-63f, 0x1.8p-63f}, {0x1p-63f, -0x1p-63f}}), 0.0f);
  EXPECT_EQ(SumOf(0, {{0x1p-63f, 0x1.8p-63f}}, {{0x1p-63f, -0x1p-63f}}), 0.0f);
}

TEST(TileUnit, LeavesFloatingPointStateAlone)
{
  const unsigned before = __builtin_ia32_stmxcsr();
  EXPECT_EQ(SumOf(0, {{0x1p127f, 0x1p127f}, {0x1p-127f, 1}}), INFINITY);
  EXPECT_EQ(SumOf(1, {{0x1p-30f, 0x1p-30f}}), 1.0f);
  EXPECT_EQ(__builtin_ia32_stmxcsr(), before);
}

TEST(TileUnit, MultipliesWholeTiles)
{
  float a[16][32];
  float b[32][16];
  std::uint32_t left[16][16];
  std::uint32_t right[16][16];
  for (std::uint64_t k = 0; k < 512; ++k) { // small integers: all is exact
    a[k / 32][k % 32] = static_cast<float>(inr::RandomBits(1, k) % 31) - 15;
    b[k / 16][k % 16] = static_cast<float>(inr::RandomBits(2, k) % 31) - 15;
  }
  for (int k = 0; k < 256; ++k) {
    left[k / 16][k % 16] = PairOf(a[k / 16][k % 16 * 2], a[k / 16][k % 16 * 2 + 1]);
    right[k / 16][k % 16] = PairOf(b[k / 16 * 2][k % 16], b[k / 16 * 2 + 1][k % 16]);
  }
  float sums[16][20];
  imitation::Configure(inr::WholeTiles);
  imitation::Zero(3);
  imitation::Load(5, left, 64);
  imitation::Load(6, right, 64);
  imitation::MultiplyAdd(3, 5, 6);
  imitation::MultiplyAdd(3, 5, 6);
  imitation::Store(3, sums, sizeof(sums[0]));
  imitation::Release();
  for (int k = 0; k < 256; ++k) {
    float sum = 0;
    for (int column = 0; column < 32; ++column) {
      sum += a[k / 16][column] * b[column][k % 16];
    }
    ASSERT_EQ(sums[k / 16][k % 16], 2 * sum) << k;
  }
}

TEST(TileUnit, RefusesShapesThatTheProcessorWould)
{
  const std::function<void(inr::TileShapes&)> mistakes[] = {
      [](auto& shapes) { shapes.palette = 2; },
      [](auto& shapes) { shapes.startRow = 1; },
      [](auto& shapes) { shapes.reserved[13] = 1; },
      [](auto& shapes) { shapes.rows[7] = 17; },
      [](auto& shapes) { shapes.bytesPerRow[0] = 68; },
      [](auto& shapes) { shapes.rows[2] = 0; },
      [](auto& shapes) { shapes.bytesPerRow[2] = 0; },
      [](auto& shapes) { shapes.rows[8] = shapes.bytesPerRow[8] = 4; },
  };
  for (const auto& mistake : mistakes) {
    inr::TileShapes shapes = inr::WholeTiles;
    mistake(shapes);
    EXPECT_THROW(imitation::Configure(shapes), TileFault);
    EXPECT_FALSE(imitation::IsConfigured());
  }
}

TEST(TileUnit, RefusesTilesThatDoNotFit)
{
  float memory[16 * 16] = {};
  EXPECT_THROW(imitation::Zero(0), TileFault); // nothing is configured
  EXPECT_THROW(imitation::Load(0, memory, 64), TileFault);
  inr::TileShapes shapes = inr::WholeTiles;
  shapes.rows[5] = 8;
  shapes.bytesPerRow[6] = 32;
  shapes.rows[7] = shapes.bytesPerRow[7] = 0;
  imitation::Configure(shapes);
  EXPECT_THROW(imitation::Zero(7), TileFault);
  EXPECT_THROW(imitation::Zero(8), TileFault);
  EXPECT_THROW(imitation::Store(0, memory, 60), TileFault);
  EXPECT_THROW(imitation::MultiplyAdd(0, 0, 1), TileFault);
  EXPECT_THROW(imitation::MultiplyAdd(0, 1, 0), TileFault);
  EXPECT_THROW(imitation::MultiplyAdd(0, 1, 1), TileFault);
  EXPECT_THROW(imitation::MultiplyAdd(0, 5, 1), TileFault); // rows
  EXPECT_THROW(imitation::MultiplyAdd(0, 1, 6), TileFault); // columns
  EXPECT_THROW(imitation::MultiplyAdd(0, 1, 5), TileFault); // pairs
  EXPECT_NO_THROW(imitation::MultiplyAdd(0, 1, 2));
  imitation::Release();
}

} // namespace test::tile_unit
