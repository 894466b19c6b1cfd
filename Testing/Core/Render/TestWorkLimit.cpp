// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds that hold whatever the clock says when it is asked.
#include "Core/Render/Tiles/WorkLimit.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace test::work_limit {

constexpr double Seconds = 0.02;

TEST(WorkLimit, LeavesAPartOfAllTheTimeForLoading)
{
  const inr::WorkLimit limit(Seconds, false);
  const inr::Timer later; // than the limit's own
  double passed = 0;
  while (passed < 3 * Seconds) {
    passed = later.seconds();
    for (const double part : {0.25, 0.5}) {
      const double given = limit.secondsForLoading(part);
      EXPECT_GE(given, part * Seconds);
      EXPECT_GE(given, part * passed);
    }
  }
}

TEST(WorkLimit, GivesLoadingNoMoreThanThatOrWhatIsLeft)
{
  const inr::Timer earlier;
  const inr::WorkLimit limit(Seconds, false);
  const inr::Timer later(Seconds);
  double passed = 0;
  while (passed < 3 * Seconds) {
    const double left = later.left();
    const double given = limit.secondsForLoading();
    passed = earlier.seconds();
    EXPECT_LE(given, std::max(left, 0.25 * std::max(Seconds, passed)));
  }
}

TEST(WorkLimit, OfSeveralPicturesIsAnEqualPartOfAllTimes)
{
  const inr::WorkLimit shared(0.4, false, 4);
  EXPECT_TRUE(shared.endsWithin(0.1));
  EXPECT_LE(shared.secondsForPass(true), 0.1);
  EXPECT_LE(shared.secondsForPass(false), 0.2);
  EXPECT_LE(inr::WorkLimit(1e-9, false, 4).secondsForPass(false), 0.25 / 4);
  EXPECT_FALSE(inr::WorkLimit(0, false, 4).isLimited());
}

TEST(WorkLimit, EndsNothingWhereThereIsNone)
{
  const inr::WorkLimit none(0, false);
  EXPECT_FALSE(none.isLimited());
  EXPECT_FALSE(none.isTimed());
  EXPECT_FALSE(none.endsWithin(1e9));
}

TEST(WorkLimit, LooksAtNoClockWhereItIsCounted)
{
  const inr::WorkLimit counted(1e9, true);
  EXPECT_TRUE(counted.isLimited());
  EXPECT_FALSE(counted.isTimed());
  EXPECT_TRUE(counted.endsWithin(0));
  const inr::WorkLimit timed(1e9, false);
  EXPECT_TRUE(timed.isTimed());
  EXPECT_FALSE(timed.endsWithin(1));
  EXPECT_TRUE(timed.endsWithin(2e9));
}

} // namespace test::work_limit
