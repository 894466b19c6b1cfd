// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Device/Kernels/Half.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace test::half {

using namespace inr::cuda;

TEST(Half, EveryOneBecomesTheFloatThatItIs)
{
  for (int bits = 0; bits < 65536; ++bits) {
    Imath::half half;
    half.setBits(static_cast<std::uint16_t>(bits));
    const float value = ToFloat(static_cast<HalfBits>(bits));
    if (half.isNan()) {
      EXPECT_TRUE(std::isnan(value)) << bits;
    } else {
      EXPECT_EQ(BitsOf(value), BitsOf(static_cast<float>(half))) << bits;
    }
  }
}

TEST(Half, FloatsAreRoundedToTheNearestEvenOne)
{
  for (int bits = 0; bits < 0x7c00; ++bits) { // each, its neighbours' middles and what is beside
    const float here = ToFloat(static_cast<HalfBits>(bits));
    const float next = bits == 0x7bff ? 65536.0f : ToFloat(static_cast<HalfBits>(bits + 1));
    const float middle = here + (next - here) / 2;
    for (const float value : {here, middle, std::nextafter(middle, here),
                              std::nextafter(middle, next), -middle, -here}) {
      EXPECT_EQ(ToHalf(value), Imath::half(value).bits()) << value;
    }
  }
  EXPECT_EQ(ToHalf(INFINITY), 0x7c00);
  EXPECT_EQ(ToHalf(-1e30f), 0xfc00);
  EXPECT_EQ(ToHalf(std::numeric_limits<float>::denorm_min()), 0);
  EXPECT_TRUE(std::isnan(ToFloat(ToHalf(NAN))));
}

TEST(Half, PairsKeepTheirOrderAndMarkWhatDoesNotFit)
{
  const std::uint32_t pair = PackHalves(1.5f, -LargestHalf);
  EXPECT_EQ(LowHalf(pair), 1.5f);
  EXPECT_EQ(HighHalf(pair), -LargestHalf);
  EXPECT_TRUE(std::isnan(LowHalf(PackHalves(65520.0f, 1.0f)))); // would round to 65536
  EXPECT_EQ(HighHalf(PackHalves(65520.0f, 1.0f)), 1.0f);
  EXPECT_EQ(HighHalf(PackHalves(0.0f, 65519.0f)), LargestHalf);
  EXPECT_TRUE(std::isnan(HighHalf(PackHalves(0.0f, -INFINITY))));
  EXPECT_TRUE(std::isnan(LowHalf(PackHalves(NAN, 0.0f))));
}

} // namespace test::half
