// SPDX-License-Identifier: BSD-3-Clause
#include "Core/AlignedVector.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <utility>

namespace test::aligned_vector {

std::uintptr_t PastALine(const void* memory)
{
  return reinterpret_cast<std::uintptr_t>(memory) % 64;
}

TEST(AlignedVector, BeginsAtALineHoweverLongAndComeBy)
{
  for (const std::size_t count : {1, 3, 17, 1000, 1 << 20}) {
    inr::AlignedVector<float> values(count, 1.5f);
    EXPECT_EQ(PastALine(values.data()), 0u) << count;
    inr::AlignedVector<float> copy = values;
    EXPECT_EQ(PastALine(copy.data()), 0u) << count;
    copy.push_back(2.5f);
    EXPECT_EQ(PastALine(copy.data()), 0u) << count;
    EXPECT_EQ(copy[count - 1], 1.5f);
    const float* const memory = values.data();
    const inr::AlignedVector<float> moved = std::move(values);
    EXPECT_EQ(moved.data(), memory);
  }
}

TEST(AlignedVector, RefusesMoreBytesThanCanBeCounted)
{
  inr::LineAllocator<float> allocator;
  constexpr std::size_t most = std::numeric_limits<std::size_t>::max();
  EXPECT_THROW(allocator.allocate(most / sizeof(float) + 1), std::bad_array_new_length);
}

TEST(AlignedVector, HoldsTableEntriesThatLieInOneLine)
{
  for (const int features : {1, 2, 4, 8}) {
    for (const int neurons : {16, 32, 64}) {
      inr::Description description = SmallDescription();
      description.grid.features = features;
      description.network.neurons = neurons;
      const auto model = RandomModel(description);
      const inr::Layout layout(description);
      for (const inr::GridLevel& level : layout.levels) {
        const float* const table = model->parameters.data() + layout.gridOffset +
                                   level.offset * static_cast<std::uint64_t>(features);
        EXPECT_EQ(PastALine(table) % (static_cast<std::size_t>(features) * sizeof(float)), 0u);
      }
    }
  }
}

} // namespace test::aligned_vector
