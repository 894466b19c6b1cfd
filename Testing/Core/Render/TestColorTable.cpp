// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Random.h"
#include "Core/Render/Scene/ColorTable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace test::color_table {

inr::VolumeInfo Range(double low, double high)
{
  inr::VolumeInfo info;
  info.low = low;
  info.high = high;
  return info;
}

inr::TransferFunction RandomFunction(std::uint64_t seed)
{
  std::uint64_t counter = 0;
  const auto random = [&] { return inr::RandomUnit(seed, counter++); };
  inr::TransferFunction function;
  function.low = 4.0 * random() - 1.0;
  function.high = function.low + 0.01 + 4.0 * random();
  function.table.resize(2 + static_cast<std::size_t>(60 * random()));
  for (glm::vec4& entry : function.table) {
    entry = {random(), random(), random(), random() < 0.5f ? 0.0f : random()};
  }
  function.below.w = random();
  function.above.w = random();
  return function;
}

TEST(ColorTable, InterpolatesBetweenNodes)
{
  inr::TransferFunction function;
  function.low = 10;
  function.high = 20;
  function.table = {{0, 0, 0, 0}, {1, 0, 0, 0.5f}, {0, 1, 0, 1}};
  function.below = {9, 9, 9, 0.25f};
  const inr::ColorTable table(function, Range(0, 100));
  EXPECT_NEAR(table.lookup().at(0.125f).w, 0.25f, 1e-6); // value 12.5
  EXPECT_NEAR(table.lookup().at(0.175f).y, 0.5f, 1e-6);
  EXPECT_EQ(table.lookup().at(0.05f).w, 0.25f);
  EXPECT_EQ(table.lookup().at(0.9f).w, 0.0f);
}

TEST(ColorTable, LogarithmicTablesAreEvenInTheLogarithm)
{
  inr::TransferFunction function;
  function.low = 1;
  function.high = 100;
  function.logarithmic = true;
  function.table = {{0, 0, 0, 0}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}};
  const inr::ColorTable table(function, Range(0, 100));
  EXPECT_NEAR(table.lookup().at(0.1f).w, 0.5f, 1e-5);
  EXPECT_NEAR(table.lookup().at(std::sqrt(1000.0f) / 100).w, 0.75f, 1e-5);
  EXPECT_EQ(table.lookup().at(0.0f).w, 0.0f); // log 0: below
}

// Found by fuzzing: a range of a denormal number, whose inverse is infinite.
TEST(ColorTable, AreInPlaceForRangesAtTheEndsOfDoubles)
{
  const double smallest = std::numeric_limits<double>::denorm_min();
  const double largest = std::numeric_limits<double>::max();
  const std::pair<double, double> ranges[] = {
      {0, smallest},       {-smallest, 3 * smallest}, {0, 1e-310},
      {-largest, largest}, {0.5 * largest, largest},  {-1e300, 1e200}};
  inr::TransferFunction function;
  function.table = {{0, 0, 0, 0}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}};
  for (const auto& [low, high] : ranges) {
    function.low = low;
    function.high = high;
    const inr::ColorTable table(function, Range(low, high));
    EXPECT_EQ(table.lookup().at(0.0f).w, 0.0f) << low;
    EXPECT_NEAR(table.lookup().at(0.25f).w, 0.25f, 1e-6) << low;
    EXPECT_EQ(table.lookup().at(1.0f).w, 1.0f) << low;
  }
  function.low = 0; // of other ranges than the volume's: all is above, or all below
  function.high = smallest;
  const float above = inr::ColorTable(function, Range(1, largest)).lookup().coordinate(0.5f);
  EXPECT_TRUE(above > 2.0f && std::isfinite(above)) << above;
  function.high = largest;
  EXPECT_EQ(inr::ColorTable(function, Range(0, smallest)).lookup().coordinate(0.5f), 0.0f);
}

TEST(ColorTable, TakesLogarithmsOfWhatFloatCannotHold)
{
  inr::TransferFunction function;
  function.logarithmic = true;
  function.table = {{0, 0, 0, 0}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}};
  for (const double unit : {1e-306, 1e-200, 1.0, 1e300}) {
    function.low = 1e-3 * unit;
    function.high = unit;
    const inr::ColorTable table(function, Range(0, 2 * unit));
    EXPECT_NEAR(table.lookup().at(0.5e-3f).w, 0.0f, 1e-5) << unit;
    EXPECT_NEAR(table.lookup().at(0.5e-2f).w, 1.0f / 3, 1e-5) << unit;
    EXPECT_NEAR(table.lookup().at(0.5f).w, 1.0f, 1e-5) << unit;
    EXPECT_EQ(table.lookup().at(0.0f).w, 0.0f) << unit;
  }
  // As far below 0 as above, the volume is twice as wide as its largest value.
  function.low = 1e-25;
  function.high = 8e4;
  const inr::ColorTable signs(function, Range(-8e4, 8e4));
  EXPECT_NEAR(signs.lookup().at(0.75f).w, std::log(4e29) / std::log(8e29), 1e-5);
}

TEST(ColorTable, LogarithmsHoldOverNarrowRanges)
{
  inr::TransferFunction function;
  function.logarithmic = true;
  function.table = {glm::vec4(0), glm::vec4(0.5f), glm::vec4(1)};
  function.low = 1e5;
  for (const double width : {1.0, 1e-1, 1e-2, 2e-3, 5e-4, 1e-5, 1e-9}) {
    function.high = function.low * (1 + width);
    const inr::ColorTable table(function, Range(function.low, function.high));
    for (int k = 0; k <= 100; ++k) {
      const double value = function.low + 0.01 * k * (function.high - function.low);
      const double truth = std::log(value / function.low) / std::log(function.high / function.low);
      EXPECT_NEAR(table.lookup().at(0.01f * static_cast<float>(k)).x, truth, 2e-4) << width;
    }
  }
}

TEST(ColorTable, TheEndsOfItsRangeAreInATable)
{
  inr::TransferFunction function;
  function.table.assign(256, glm::vec4(0.5f));
  function.below = function.above = glm::vec4(0);
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    function.logarithmic = seed % 2 == 0;
    function.low = std::pow(10.0, 6 * inr::RandomUnit(seed, 0) - 3);
    // From narrow to more decades than there are between floats.
    function.high = function.low * (1 + std::pow(10.0, 40 * inr::RandomUnit(seed, 1) - 5));
    const double beyond = (function.high - function.low) * 1000 * inr::RandomUnit(seed, 2);
    const auto tell = [&] {
      return testing::Message() << function.low << " to " << function.high << ", logarithmic "
                                << function.logarithmic << ", beyond " << beyond;
    };
    const auto at = [&](double low, double high, float y) {
      return inr::ColorTable(function, Range(low, high)).lookup().at(y).w;
    };
    EXPECT_EQ(at(function.low, function.high, 0), 0.5f) << tell();
    EXPECT_EQ(at(function.low, function.high, 1), 0.5f) << tell();
    EXPECT_EQ(at(function.low - beyond, function.high, 1), 0.5f) << tell();
    EXPECT_EQ(at(function.low, function.high + beyond, 0), 0.5f) << tell();
  }
}

TEST(ColorTable, MajorantBoundsEveryValueOfARange)
{
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const inr::ColorTable table(RandomFunction(seed), Range(-1, 4));
    float low = inr::RandomUnit(seed, 1000);
    float high = inr::RandomUnit(seed, 1001);
    if (low > high) {
      std::swap(low, high);
    }
    const float bound = table.maximumExtinction({low, high});
    for (int k = 0; k <= 200; ++k) {
      const float y = std::min(high, low + (high - low) * static_cast<float>(k) / 200.0f);
      ASSERT_LE(-std::log1p(-table.lookup().at(y).w), bound) << "seed " << seed << " y " << y;
    }
  }
}

TEST(ColorTable, MajorantIsTight)
{
  inr::TransferFunction function;
  function.table.assign(101, glm::vec4(0));
  function.table[50].w = 0.9f;
  const inr::ColorTable table(function, Range(0, 1));
  EXPECT_EQ(table.maximumExtinction({0.0f, 0.47f}), 0.0f);
  EXPECT_EQ(table.maximumExtinction({0.53f, 1.0f}), 0.0f);
  EXPECT_EQ(table.maximumExtinction({0.2f, 0.8f}), -std::log1p(-0.9f));
  EXPECT_EQ(table.maximumExtinction({1.0f, -1.0f}), 0.0f); // empty
}

TEST(ColorTable, RefusesNonsense)
{
  const auto refused = [](const std::function<void(inr::TransferFunction&)>& spoil) {
    inr::TransferFunction function;
    function.table = {glm::vec4(0), glm::vec4(1)};
    spoil(function);
    EXPECT_THROW(inr::ColorTable(function, Range(0, 1)), inr::Error);
  };
  refused([](auto& function) { function.table.pop_back(); });
  refused([](auto& function) { function.table.assign(65537, glm::vec4(0)); });
  refused([](auto& function) { function.table[0].x = NAN; });
  refused([](auto& function) { function.table[0].w = 1.5f; });
  refused([](auto& function) { function.high = function.low; });
  refused([](auto& function) { function.logarithmic = true; });
}

TEST(ColorTable, KnowsWhetherAnyValueIsTransparent)
{
  const auto hides = [](float inside, float below, float above) {
    inr::TransferFunction function;
    function.table.assign(3, glm::vec4(1, 1, 1, 0.5f));
    function.table[1].w = inside;
    function.below.w = below;
    function.above.w = above;
    return inr::ColorTable(function, Range(0, 1)).hidesAny();
  };
  EXPECT_FALSE(hides(0.1f, 0.1f, 0.1f));
  EXPECT_FALSE(hides(1e-30f, 1, 1));
  EXPECT_TRUE(hides(0, 0.1f, 0.1f));
  EXPECT_TRUE(hides(0.1f, 0, 0.1f));
  EXPECT_TRUE(hides(0.1f, 0.1f, 0));
}

} // namespace test::color_table
