// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Model.h"

#include <gtest/gtest.h>

#include <cstdint>

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
