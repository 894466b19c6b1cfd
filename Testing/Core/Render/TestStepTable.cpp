// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/StepTable.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::step_table {

/// RGBA of a sample of one of the lengths, read as the compositing kernels do.
glm::vec4 Read(const inr::StepLookup& lookup, float y, int length)
{
  float position = lookup.scale * y + lookup.bias;
  int row = 0;
  float weight = 0;
  if (position >= 2 && position <= static_cast<float>(lookup.rows - 3)) {
    row = static_cast<int>(position);
    weight = position - static_cast<float>(row);
  } else if (position > 2) {
    row = lookup.rows - 2;
  }
  const float* first = lookup.entries + 4 * (length * lookup.rows + row);
  glm::vec4 entry;
  for (int k = 0; k < 4; ++k) {
    entry[k] = first[k] + (first[k + 4] - first[k]) * weight;
  }
  if (entry.w > 1) {
    entry.w = inr::SteepOpacityOf(lookup, length, first[3], first[7], weight);
  }
  return entry;
}

TEST(StepTable, FollowsThePowerBetweenEntries)
{
  inr::TransferFunction function;
  function.table = {{1, 0, 0, 0}, {0, 1, 0, 0.3f}, {0, 0, 1, 1}, {0, 0, 0, 0.1f}};
  const inr::ColorTable colors(function, inr::VolumeInfo{});
  for (const double length : {0.1, 1.0, 7.0}) {
    const inr::StepTable table(colors.lookup(), length, 4);
    for (int number = 0; number < 4; ++number) {
      for (float y = 0; y <= 1; y += 1.0f / 1237) {
        const glm::vec4 entry = colors.lookup().at(y);
        const double exact =
            1 - std::pow(1.0 - entry.w, length * static_cast<double>(inr::StepsOf(number)));
        const glm::vec4 read = Read(table.lookup(), y, number);
        EXPECT_NEAR(read.w, exact, 2e-3) << y << " " << length;
        EXPECT_NEAR(read.x, entry.x, 1e-4);
        EXPECT_NEAR(read.z, entry.z, 1e-4);
      }
    }
  }
}

// Steps of an opacity unit distance are linear in it, and the longest samples of opaque values are
// opaque; what lies in between is neither.
TEST(StepTable, FollowsThePowerOfAllLengths)
{
  inr::TransferFunction function;
  function.table = {{1, 1, 1, 0.2f}, {1, 1, 1, 0.95f}};
  const inr::ColorTable colors(function, inr::VolumeInfo{});
  const int lengths = inr::SampleLengths(6);
  const inr::StepTable table(colors.lookup(), 1.0, lengths);
  for (int number = 0; number < lengths; ++number) {
    for (float y = 0; y <= 1; y += 1.0f / 1237) {
      const double opacity = colors.lookup().at(y).w;
      const double exact = 1 - std::pow(1.0 - opacity, inr::StepsOf(number));
      ASSERT_NEAR(Read(table.lookup(), y, number).w, exact, 4e-4) << y << " " << number;
    }
  }
}

// Peaks that reach 1 or almost do, the ends of a plateau, and of the table: where short samples let
// nothing through at one value and nearly everything next to it.
TEST(StepTable, FollowsOpacitiesNextToOne)
{
  for (const float top : {1.0f, 0.99999f, 0.7f}) {
    inr::TransferFunction function;
    function.table = {{1, 0, 0, 0}, {0, 1, 0, top}, {0, 0, 1, 0.2f}, {0, 0, 0, 1}, {0, 0, 0, 1}};
    const inr::ColorTable colors(function, inr::VolumeInfo{});
    for (const double length : {1e-5, 0.001, 0.02, 0.4, 1.0, 5.0}) {
      const inr::StepTable table(colors.lookup(), length, 2);
      const float rows = table.lookup().scale; // by value
      for (int number = 0; number < 2; ++number) {
        const double power = length * static_cast<double>(inr::StepsOf(number));
        for (const float at : {0.25f, 0.75f, 0.875f, 1.0f}) {
          for (int k = -20; k <= 20; ++k) { // two rows to either side
            const float y = std::min(at + static_cast<float>(k) / 10 / rows, 1.0f);
            // In double: next to 1 a float has few digits of what is let through.
            const double cell = std::min(std::floor(4.0 * y), 3.0);
            const double begin = function.table[static_cast<std::size_t>(cell)].w;
            const double end = function.table[static_cast<std::size_t>(cell) + 1].w;
            const double through = 1 - (begin + (end - begin) * (4.0 * y - cell));
            const double exact = through > 0 ? -std::expm1(power * std::log(through)) : 1;
            EXPECT_NEAR(Read(table.lookup(), y, number).w / exact, 1, 2e-2)
                << top << " " << length << " " << number << " " << y;
          }
        }
      }
    }
  }
}

TEST(StepTable, StepsAtTheEndsOfTheRange)
{
  inr::TransferFunction function = UniformMedium(0.5f);
  function.low = 0.25;
  function.high = 0.75;
  function.below = {0, 0, 0, 0};
  function.above = {1, 0, 0, 0.75f};
  const inr::ColorTable colors(function, inr::VolumeInfo{});
  const inr::StepTable table(colors.lookup(), 1.0, 3);
  EXPECT_EQ(Read(table.lookup(), 0.2f, 0).w, 0.0f);
  EXPECT_FLOAT_EQ(Read(table.lookup(), 0.3f, 0).w, 0.5f);
  EXPECT_FLOAT_EQ(Read(table.lookup(), 0.3f, 2).w, 0.75f);
  EXPECT_FLOAT_EQ(Read(table.lookup(), 0.8f, 0).w, 0.75f);
  EXPECT_FLOAT_EQ(Read(table.lookup(), 0.8f, 2).w, 0.9375f);
}

} // namespace test::step_table
