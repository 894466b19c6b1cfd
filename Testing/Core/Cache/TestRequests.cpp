// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/Requests.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace test::requests {

inr::BrickKey Brick(int level, std::int64_t x) { return inr::KeyOf({level, {x, 0, 0}}); }

TEST(Requests, AreRankedByWhatTheyContribute)
{
  inr::RequestRanking ranking;
  inr::RequestList first;
  first.add(Brick(0, 1), 1.0f);
  first.add(Brick(0, 2), 0.5f);
  first.add(Brick(0, 1), 1.0f);
  ranking.add(first);
  inr::RequestList second;
  second.add(Brick(0, 3), 1.5f);
  second.add(Brick(0, 2), 2.0f);
  ranking.add(second);
  using Keys = std::vector<inr::BrickKey>;
  EXPECT_EQ(ranking.count(), 3);
  EXPECT_EQ(ranking.ranked(9, true), (Keys{Brick(0, 2), Brick(0, 1), Brick(0, 3)}));
  EXPECT_EQ(ranking.ranked(2, true), (Keys{Brick(0, 2), Brick(0, 1)}));
  EXPECT_EQ(ranking.ranked(9, false), (Keys{Brick(0, 1), Brick(0, 2), Brick(0, 3)}));
}

TEST(Requests, CoarserLevelsComeFirstAmongEquals)
{
  inr::RequestRanking ranking;
  inr::RequestList list;
  for (std::int64_t k = 0; k < 20; ++k) {
    list.add(Brick(static_cast<int>(k % 4), k), 1.0f);
  }
  ranking.add(list);
  const std::vector<inr::BrickKey> keys = ranking.ranked(20, true);
  for (std::size_t k = 1; k < keys.size(); ++k) {
    const inr::BrickId before = inr::IdOf(keys[k - 1]);
    const inr::BrickId after = inr::IdOf(keys[k]);
    EXPECT_TRUE(before.level > after.level ||
                (before.level == after.level && before.at.x < after.at.x));
  }
}

TEST(Requests, SumsDoNotDependOnHowAListWasMade)
{
  inr::RequestList apart; // further apart than a list looks back
  for (std::int64_t round = 0; round < 3; ++round) {
    for (std::int64_t k = 0; k < 20; ++k) {
      apart.add(Brick(0, k), static_cast<float>(k));
    }
  }
  inr::RequestRanking ranking;
  ranking.add(apart);
  EXPECT_EQ(ranking.count(), 20);
  EXPECT_EQ(ranking.ranked(1, true).front(), Brick(0, 19));
}

TEST(Requests, ForOthersInTheirPlaceAddUp)
{
  inr::RequestRanking ranking;
  inr::RequestList list;
  list.add(Brick(0, 4), 1.0f);
  list.add(Brick(0, 7), 4.0f);
  list.add(Brick(0, 5), 1.5f);
  list.add(Brick(1, 9), 0.5f);
  ranking.add(list);
  const inr::RequestRanking halves = ranking.replaced([](inr::BrickKey key) {
    return Brick(1, inr::IdOf(key).level == 0 ? inr::IdOf(key).at.x / 2 : 9);
  });
  using Keys = std::vector<inr::BrickKey>;
  EXPECT_EQ(halves.count(), 3);
  EXPECT_EQ(halves.ranked(9, true), (Keys{Brick(1, 3), Brick(1, 2), Brick(1, 9)}));
  EXPECT_EQ(ranking.count(), 4);
}

/// A wish that is `place`-th in a picture of random wishes for a few hundred bricks.
inr::Request RandomWish(std::uint64_t picture, std::uint64_t place)
{
  const std::uint64_t bits = inr::RandomBits(picture, place);
  const int level = static_cast<int>(bits % 5);
  const auto x = static_cast<std::int64_t>(bits / 5 % (300U >> level));
  // Halves add up exactly in any order, and often to the same.
  return {Brick(level, x), 0.5f * static_cast<float>(bits >> 40 & 3)};
}

/// The bricks of one picture, ranked by adding up in a map and sorting in the order that is
/// promised.
std::vector<inr::BrickKey> RankedByASimpleModel(const std::vector<inr::Request>& wishes)
{
  std::map<inr::BrickKey, double> contributions;
  for (const inr::Request& wish : wishes) {
    contributions[wish.key] += static_cast<double>(wish.contribution);
  }
  std::vector<inr::BrickKey> keys;
  for (const auto& entry : contributions) {
    keys.push_back(entry.first); // in order of the keys, which a stable sort keeps
  }
  std::stable_sort(keys.begin(), keys.end(), [](inr::BrickKey a, inr::BrickKey b) {
    return inr::IdOf(a).level > inr::IdOf(b).level;
  });
  std::stable_sort(keys.begin(), keys.end(), [&](inr::BrickKey a, inr::BrickKey b) {
    return contributions[a] > contributions[b];
  });
  return keys;
}

std::vector<inr::BrickKey> InOrderOfAppearance(const std::vector<inr::Request>& wishes)
{
  std::vector<inr::BrickKey> keys;
  for (const inr::Request& wish : wishes) {
    if (std::find(keys.begin(), keys.end(), wish.key) == keys.end()) {
      keys.push_back(wish.key);
    }
  }
  return keys;
}

TEST(Requests, AreRankedAsASimpleModelRanksThem)
{
  for (std::uint64_t picture = 0; picture < 100; ++picture) {
    std::vector<inr::Request> wishes(inr::RandomBits(7, picture) % 2000);
    inr::RequestRanking ranking;
    inr::RequestList tile;
    for (std::uint64_t k = 0; k < wishes.size(); ++k) {
      wishes[k] = RandomWish(picture, k);
      tile.add(wishes[k].key, wishes[k].contribution);
      if (k % 90 == 89) {
        ranking.add(tile);
        tile = {};
      }
    }
    ranking.add(tile);
    std::vector<inr::BrickKey> best = RankedByASimpleModel(wishes);
    std::vector<inr::BrickKey> first = InOrderOfAppearance(wishes);
    ASSERT_EQ(ranking.count(), static_cast<std::int64_t>(best.size()));
    ASSERT_EQ(ranking.ranked(10000, true), best) << picture;
    ASSERT_EQ(ranking.ranked(10000, false), first) << picture;
    best.resize(std::min<std::size_t>(best.size(), 40));
    first.resize(best.size());
    ASSERT_EQ(ranking.ranked(40, true), best) << picture;
    ASSERT_EQ(ranking.ranked(40, false), first) << picture;
  }
}

} // namespace test::requests
