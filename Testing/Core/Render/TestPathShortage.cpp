// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/PathShortage.h"

#include <gtest/gtest.h>

namespace test::path_shortage {

constexpr bool First = true;
constexpr bool Waits = true;
constexpr bool Contested = true;

/// Of a picture that has wanted too much.
inr::PathShortage Found()
{
  inr::PathShortage shortage;
  shortage.begin(First, !Waits, !Contested);
  shortage.note();
  return shortage;
}

TEST(PathShortage, IsNotSupposed)
{
  inr::PathShortage shortage;
  EXPECT_FALSE(shortage.lacks());
  for (const bool first : {true, false}) {
    shortage.begin(first, Waits, !Contested);
    EXPECT_FALSE(shortage.lacks());
    shortage.check(10, 5);
    EXPECT_FALSE(shortage.lacks()); // a round is loaded for first
  }
}

TEST(PathShortage, StaysWhileItsPictureGoesOn)
{
  inr::PathShortage shortage = Found();
  shortage.begin(!First, !Waits, !Contested);
  shortage.check(1, 5);
  EXPECT_TRUE(shortage.lacks());
}

TEST(PathShortage, IsFoundAnewForAPictureInALimitedTime)
{
  inr::PathShortage shortage = Found();
  shortage.begin(First, !Waits, !Contested);
  EXPECT_FALSE(shortage.lacks());
}

TEST(PathShortage, IsGuessedWhereSomebodyWaits)
{
  for (const int wanted : {5, 6}) {
    inr::PathShortage shortage = Found();
    shortage.begin(First, Waits, !Contested);
    EXPECT_TRUE(shortage.lacks());
    shortage.check(wanted, 5);
    EXPECT_EQ(shortage.lacks(), wanted > 5);
  }
}

// Others take bricks that a picture has; at its first round it has none.
TEST(PathShortage, ComesOfOthers)
{
  inr::PathShortage shortage;
  shortage.begin(First, !Waits, Contested);
  EXPECT_FALSE(shortage.lacks());
  shortage.begin(!First, !Waits, Contested);
  EXPECT_TRUE(shortage.lacks());
}

} // namespace test::path_shortage
