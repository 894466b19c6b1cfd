// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quality/CellRanges.h"
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <limits>

namespace test::cell_ranges {

/// Of integers between two doubles, from one end of the gap to the other.
TEST(CellRanges, HoldVastIntegers)
{
  const std::int64_t base = std::int64_t{1} << 62; // from where doubles are 1024 apart
  const auto low = static_cast<double>(base);
  const double high = low + 2048;
  const inr::Arena arena(1);
  for (const std::int64_t above : {1, 300, 600, 1023, 1024, 1500, 2047}) {
    Field<std::int64_t> field{
        {4, 1, 1}, inr::ScalarType::Int64, std::vector<std::int64_t>(4, base + above)};
    inr::CellRanges ranges(field.dims, 16);
    ranges.add({field.data(), glm::i64vec3(0)}, {glm::i64vec3(0), field.dims}, arena);
    const inr::MacroCells cells = ranges.cells(low, high, 0, inr::MacroCellProvenance::Decoded);
    ASSERT_EQ(cells.ranges.size(), 1u);
    const auto place = static_cast<float>(static_cast<double>(above) / 2048);
    EXPECT_LE(cells.ranges[0].low, place) << above;
    EXPECT_GE(cells.ranges[0].high, place) << above;
    EXPECT_LE(cells.ranges[0].high - cells.ranges[0].low, 0.5f) << above;
  }
}

} // namespace test::cell_ranges
