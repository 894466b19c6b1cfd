// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Model.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace test::scalars {

using inr::ScalarType;

TEST(Scalars, NamesAreUniqueAndReadBack)
{
  for (int i = 0; i < 10; ++i) {
    const auto type = static_cast<ScalarType>(i);
    EXPECT_EQ(inr::ScalarFromName(inr::ScalarName(type)), type);
  }
  EXPECT_EQ(inr::ScalarFromName("uint16"), ScalarType::UInt16);
  EXPECT_FALSE(inr::ScalarFromName("float16"));
  EXPECT_FALSE(inr::ScalarFromName(""));
}

TEST(Scalars, SizesAreThoseOfTheTypes)
{
  EXPECT_EQ(inr::ScalarSize(ScalarType::Int8), sizeof(std::int8_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::UInt8), sizeof(std::uint8_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::Int16), sizeof(std::int16_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::UInt16), sizeof(std::uint16_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::Int32), sizeof(std::int32_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::UInt32), sizeof(std::uint32_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::Int64), sizeof(std::int64_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::UInt64), sizeof(std::uint64_t));
  EXPECT_EQ(inr::ScalarSize(ScalarType::Float32), sizeof(float));
  EXPECT_EQ(inr::ScalarSize(ScalarType::Float64), sizeof(double));
}

// Found by fuzzing: the width of a range may be rounded up.
TEST(ValueOf, StaysInTheRange)
{
  inr::VolumeInfo info;
  info.low = -1e38;
  info.high = 1.90735e32;
  for (int k = 0; k < 1000; ++k) {
    info.high *= 1.001;
    EXPECT_EQ(inr::ValueOf(info, 0.0f), info.low);
    EXPECT_LE(inr::ValueOf(info, 1.0f), info.high) << k;
    EXPECT_GT(inr::ValueOf(info, 1.0f), info.high + 1e-14 * info.low) << k;
    EXPECT_GT(inr::ValueOf(info, 1.5f), info.high) << k; // of no network's output
  }
}

} // namespace test::scalars
