// SPDX-License-Identifier: BSD-3-Clause
//
// A volume is as good as itself times a plus b, as long as its numbers can be told apart then.
#include "Testing/Core/Training/Fields.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::extremes {

/// A volume whose values are multiples of 1/1024 from 0 to 1, times a, plus b: exact for all below.
struct Change
{
  const char* name;
  double a;
  double b;
};

std::ostream& operator<<(std::ostream& out, const Change& change) { return out << change.name; }

template <class T> Field<T> Changed(inr::ScalarType type, const Change& change)
{
  Field<T> field = WaveField<T>({14, 12, 9}, type, 0, 1);
  for (T& value : field.values) {
    const double step = std::round(1024 * static_cast<double>(value)) / 1024;
    value = static_cast<T>(change.a * step + change.b);
  }
  return field;
}

template <class T> inr::ModelPointer Train(inr::ScalarType type, const Change& change)
{
  return inr::TrainModel(Changed<T>(type, change).data(), {}, Steps(30));
}

template <class T> void ExpectTheSame(inr::ScalarType type, const Change& change)
{
  const inr::ModelPointer usual = Train<T>(type, {"", 1, 0});
  const inr::ModelPointer changed = Train<T>(type, change);
  EXPECT_EQ(changed->volume.low, change.a * usual->volume.low + change.b);
  EXPECT_EQ(changed->volume.high, change.a * usual->volume.high + change.b);
  EXPECT_EQ(changed->parameters, usual->parameters);
  EXPECT_EQ(changed->steps, usual->steps);
  EXPECT_EQ(changed->quality->psnr, usual->quality->psnr);
  EXPECT_EQ(changed->quality->ssim, usual->quality->ssim);
  EXPECT_EQ(changed->quality->maxError, change.a * usual->quality->maxError);
}

class ChangedDoubles : public testing::TestWithParam<Change>
{};

TEST_P(ChangedDoubles, GiveTheSameModel)
{
  ExpectTheSame<double>(inr::ScalarType::Float64, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Changes, ChangedDoubles,
                         testing::Values(Change{"around_1e_300", 0x1p-997, 0},
                                         Change{"around_1e300", 0x1p997, 0},
                                         Change{"below_zero", 1, -3},
                                         Change{"small_at_1e9", 0x1p-12, 0x1p30},
                                         Change{"small_at_minus_1e9", 0x1p-12, -0x1p30},
                                         Change{"last_bits_at_1e12", 0x1p-2, 0x1p40}),
                         [](const auto& info) { return info.param.name; });

class ChangedFloats : public testing::TestWithParam<Change>
{};

TEST_P(ChangedFloats, GiveTheSameModel)
{
  ExpectTheSame<float>(inr::ScalarType::Float32, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Changes, ChangedFloats,
                         testing::Values(Change{"around_1e_38", 0x1p-126, 0},
                                         Change{"denormal", 0x1p-139, 0},
                                         Change{"around_1e38", 0x1p127, 0},
                                         Change{"around_zero", 1, -0.5},
                                         Change{"last_bits", 0x1p-13, 1}),
                         [](const auto& info) { return info.param.name; });

} // namespace test::extremes
