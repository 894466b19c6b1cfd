// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/Requests.h"

#include <gtest/gtest.h>

namespace {

inr::BrickKey Brick(int level, std::int64_t x) { return inr::KeyOf({level, {x, 0, 0}}); }

TEST(Requests, AreRankedByWhatTheyContribute)
{
  inr::RequestRanking ranking;
  inr::RequestList first;
  first.add(Brick(0, 1), 5, 1.0f);
  first.add(Brick(0, 2), 1, 0.5f);
  first.add(Brick(0, 1), 5, 1.0f);
  ranking.add(first);
  inr::RequestList second;
  second.add(Brick(0, 3), 1, 1.5f);
  second.add(Brick(0, 2), 1, 2.0f);
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
    list.add(Brick(static_cast<int>(k % 4), k), 1, 1.0f);
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
      apart.add(Brick(0, k), 1, static_cast<float>(k));
    }
  }
  inr::RequestRanking ranking;
  ranking.add(apart);
  EXPECT_EQ(ranking.count(), 20);
  EXPECT_EQ(ranking.ranked(1, true).front(), Brick(0, 19));
}

} // namespace
