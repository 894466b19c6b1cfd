// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Model/MacroCells.h"

#include <gtest/gtest.h>

namespace test::macro_cells {

using inr::DefaultMacroCellSize;
using inr::MakeMacroCells;

TEST(MacroCells, EdgeIsTheSmallestPowerOfTwoWithinTheBudget)
{
  EXPECT_EQ(DefaultMacroCellSize({1, 1, 1}), 16);
  EXPECT_EQ(DefaultMacroCellSize({256, 256, 256}), 16);
  EXPECT_EQ(DefaultMacroCellSize({2048, 2048, 4096}), 16); // exactly 2^22 cells
  EXPECT_EQ(DefaultMacroCellSize({2049, 2048, 4096}), 32); // one more column of cells
  EXPECT_EQ(DefaultMacroCellSize({4096, 4096, 4096}), 32); // 2^21
  EXPECT_EQ(DefaultMacroCellSize({131072, 131072, 131072}), 1024);
}

TEST(MacroCells, LastCellsOverhangTheVolume)
{
  const inr::MacroCells cells = MakeMacroCells({91, 16, 1}, 16);
  EXPECT_EQ(cells.dims, glm::i64vec3(6, 1, 1));
  EXPECT_DOUBLE_EQ(cells.spacing.x, 16.0 / 91.0);
  EXPECT_DOUBLE_EQ(cells.spacing.y, 1.0);
  EXPECT_DOUBLE_EQ(cells.spacing.z, 16.0);
  ASSERT_EQ(cells.ranges.size(), 6u);
  EXPECT_TRUE(cells.ranges.front().empty());
}

TEST(MacroCells, IndexRunsAlongXFirst)
{
  const inr::MacroCells cells = MakeMacroCells({32, 48, 64}, 16);
  EXPECT_EQ(cells.index(1, 0, 0), 1);
  EXPECT_EQ(cells.index(0, 1, 0), 2);
  EXPECT_EQ(cells.index(1, 2, 3), 1 + 2 * (2 + 3 * 3));
}

TEST(MacroCells, ImpossibleVolumesAreRefused)
{
  EXPECT_THROW(MakeMacroCells({0, 4, 4}, 16), inr::Error);
  EXPECT_THROW(MakeMacroCells({4, -1, 4}, 16), inr::Error);
  EXPECT_THROW(MakeMacroCells({4, 4, 4}, 0), inr::Error);
  EXPECT_THROW(MakeMacroCells({1 << 30, 1 << 30, 1 << 30}, 16), inr::Error);
  EXPECT_THROW(DefaultMacroCellSize({std::int64_t{1} << 62, 1, 1}), inr::Error);
}

TEST(MacroCells, RangesGrow)
{
  inr::ValueRange range;
  EXPECT_TRUE(range.empty());
  range.extend(0.5f);
  EXPECT_FLOAT_EQ(range.low, 0.5f);
  EXPECT_FLOAT_EQ(range.high, 0.5f);
  range.extend(-2.0f);
  range.extend(0.75f);
  EXPECT_FLOAT_EQ(range.low, -2.0f);
  EXPECT_FLOAT_EQ(range.high, 0.75f);
}

} // namespace test::macro_cells
