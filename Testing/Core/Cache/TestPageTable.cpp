// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/PageTable.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <iterator>
#include <map>

namespace test::page_table {

inr::BrickKey RandomKey(std::uint64_t k, std::uint64_t spread)
{
  const auto axis = [&](std::uint64_t place) {
    return static_cast<std::int64_t>(inr::RandomBits(place, k) % spread);
  };
  return inr::KeyOf({static_cast<int>(inr::RandomBits(9, k) % 3), {axis(1), axis(2), axis(3)}});
}

/// Random mapping and unmapping against a map, in `spread`^3 bricks of three levels.
void CompareWithAMap(std::uint64_t spread)
{
  constexpr std::size_t room = 300;
  inr::PageTable table(room);
  std::map<inr::BrickKey, std::int32_t> model;
  for (std::uint64_t step = 0; step < 20000; ++step) {
    const inr::BrickKey key = RandomKey(step, spread);
    if (model.count(key) == 0 && model.size() < room && inr::RandomBits(4, step) % 8 != 0) {
      model[key] = static_cast<std::int32_t>(step);
      table.map(key, static_cast<std::int32_t>(step));
    } else if (!model.empty()) {
      auto victim = std::next(model.begin(),
                              static_cast<std::ptrdiff_t>(inr::RandomBits(5, step) % model.size()));
      table.unmap(victim->first);
      EXPECT_EQ(table.find(victim->first), inr::PageTable::Unmapped);
      model.erase(victim);
    }
    const auto asked = model.find(RandomKey(step / 2, spread));
    const std::int32_t expected = asked == model.end() ? inr::PageTable::Unmapped : asked->second;
    ASSERT_EQ(table.find(RandomKey(step / 2, spread)), expected);
  }
  for (const auto& entry : model) {
    ASSERT_EQ(table.find(entry.first), entry.second);
  }
}

TEST(PageTable, BehavesLikeAMapWhereBricksAreDense) { CompareWithAMap(9); }
TEST(PageTable, BehavesLikeAMapWhereBricksAreFarApart) { CompareWithAMap(3361); }

TEST(PageTable, HasPagesOnlyForWhatIsMapped)
{
  inr::PageTable table(1000);
  for (std::int64_t k = 0; k < 64; ++k) {
    table.map(inr::KeyOf({0, {k % 4, k / 4 % 4, k / 16}}), static_cast<std::int32_t>(k));
  }
  EXPECT_EQ(table.pages(), 1);
  table.map(inr::KeyOf({0, {3360, 3360, 3360}}), 64);
  EXPECT_EQ(table.pages(), 2);
  table.unmap(inr::KeyOf({0, {3360, 3360, 3360}}));
  EXPECT_EQ(table.pages(), 1);
}

// The volume has 3.8e10 bricks; the table knows nothing but the number that may be mapped.
TEST(PageTable, MemoryFollowsWhatIsMappedInAHugeVolume)
{
  constexpr std::int64_t bricks = 100000;
  EXPECT_LE(inr::PageTable::bytesFor(bricks), bricks * 400);
  inr::PageTable table(bricks);
  std::map<inr::BrickKey, std::int32_t> model;
  for (std::uint64_t k = 0; static_cast<std::int64_t>(model.size()) < bricks; ++k) {
    const auto slot = static_cast<std::int32_t>(model.size());
    if (model.emplace(RandomKey(k, 3361), slot).second) {
      table.map(RandomKey(k, 3361), slot);
    }
  }
  EXPECT_LE(table.pages(), bricks);
  for (const auto& entry : model) {
    ASSERT_EQ(table.find(entry.first), entry.second);
  }
  for (std::uint64_t k = 0; k < 100000; ++k) {
    const inr::BrickKey key = RandomKey(k + (std::uint64_t{1} << 40), 3361);
    ASSERT_EQ(table.find(key) < 0, model.count(key) == 0);
  }
  for (const auto& entry : model) {
    table.unmap(entry.first);
  }
  EXPECT_EQ(table.pages(), 0);
}

} // namespace test::page_table
