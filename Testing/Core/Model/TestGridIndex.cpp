// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/GridIndex.h"

#include <gtest/gtest.h>

using inr::GridIndex;
using inr::HashFunction;
using inr::HashRule;

namespace test::grid_index {

inr::GridLevel Level(int level, HashRule rule, int log2HashmapSize = 19)
{
  inr::Description description;
  description.grid.levels = level + 1;
  description.grid.features = 1;
  description.grid.log2HashmapSize = log2HashmapSize;
  description.grid.rule = rule;
  return inr::Layout(description).levels.back();
}

// PCG32 as defined: one step after the other.
struct SequentialPcg32
{
  std::uint64_t state = 0;
  std::uint32_t next()
  {
    const std::uint64_t old = this->state;
    this->state = old * 6364136223846793005ull + 3ull;
    const auto xorshifted = static_cast<std::uint32_t>(((old >> 18u) ^ old) >> 27u);
    const auto rot = static_cast<unsigned>(old >> 59u);
    return rot == 0 ? xorshifted : (xorshifted >> rot) | (xorshifted << (32u - rot));
  }
};

TEST(GridIndex, DenseLevelsRunAlongXFirst)
{
  const inr::GridLevel level = Level(0, HashRule::Wrapping);
  EXPECT_EQ(GridIndex(level, HashFunction::CoherentPrime, 3, 5, 7), 3u + 16u * (5u + 16u * 7u));
}

TEST(GridIndex, UpperCornersAlias)
{
  const inr::GridLevel level = Level(0, HashRule::Wrapping);
  EXPECT_EQ(GridIndex(level, HashFunction::CoherentPrime, 16, 2, 3),
            GridIndex(level, HashFunction::CoherentPrime, 0, 3, 3));
  EXPECT_EQ(GridIndex(level, HashFunction::CoherentPrime, 4, 5, 16),
            GridIndex(level, HashFunction::CoherentPrime, 4, 5, 0));
}

TEST(GridIndex, HashedLevelsMultiplyAndXor)
{
  const inr::GridLevel level = Level(5, HashRule::Wrapping);
  ASSERT_TRUE(level.hashed);
  const std::uint32_t x = 400, y = 123, z = 77;
  const auto modulo = [](std::uint64_t a) { return static_cast<std::uint32_t>(a); };
  const std::uint32_t second = modulo(y * 2654435761ull), third = modulo(z * 805459861ull);
  EXPECT_EQ(GridIndex(level, HashFunction::CoherentPrime, x, y, z), (x ^ second ^ third) % 524288u);
  EXPECT_EQ(GridIndex(level, HashFunction::Prime, x, y, z),
            (modulo(x * 1958374283ull) ^ second ^ third) % 524288u);
  EXPECT_EQ(GridIndex(level, HashFunction::ReversedPrime, x, y, z),
            (modulo(x * 2165219737ull) ^ modulo(y * 1434869437ull) ^ modulo(z * 2097192037ull)) %
                524288u);
}

TEST(GridIndex, RngIsTheSequentialGeneratorAtThePackedPosition)
{
  SequentialPcg32 generator;
  generator.next();
  generator.state += 1337;
  generator.next();
  for (std::uint32_t step = 0; step < 1000; ++step) {
    ASSERT_EQ(inr::HashCorner(HashFunction::Rng, step, 0, 0), generator.next()) << step;
  }
}

TEST(GridIndex, RngPacksTwentyOneBitsPerAxis)
{
  EXPECT_EQ(inr::HashCorner(HashFunction::Rng, 5, 1, 0), inr::Pcg32At(5 + (1ull << 21)));
  EXPECT_EQ(inr::HashCorner(HashFunction::Rng, 5, 3, 9),
            inr::Pcg32At(5 + (3ull << 21) + (9ull << 42)));
}

// 65536^2 = 2^32 wraps to a stride of zero: z is lost and the level is not hashed at all.
TEST(GridIndex, WrappingRuleLosesAnAxisOnFineLevels)
{
  const inr::GridLevel level = Level(12, HashRule::Wrapping);
  ASSERT_EQ(level.resolution, 65536u);
  EXPECT_FALSE(level.hashed);
  EXPECT_EQ(GridIndex(level, HashFunction::CoherentPrime, 70, 5, 1),
            GridIndex(level, HashFunction::CoherentPrime, 70, 5, 60000));
  EXPECT_EQ(GridIndex(level, HashFunction::CoherentPrime, 70, 5, 1), (70u + 5u * 65536u) % 524288u);
  EXPECT_TRUE(Level(11, HashRule::Wrapping).hashed);
  EXPECT_FALSE(Level(15, HashRule::Wrapping).hashed);
  EXPECT_TRUE(Level(16, HashRule::Wrapping).hashed); // the first product is over the table at once
  EXPECT_FALSE(Level(7, HashRule::Wrapping, 22).hashed);
  EXPECT_TRUE(Level(7, HashRule::Wrapping, 21).hashed);
}

TEST(GridIndex, ExactRuleAlwaysHashesThem)
{
  for (const int log2HashmapSize : {19, 22}) {
    for (const int level : {7, 11, 12, 13}) {
      EXPECT_TRUE(Level(level, HashRule::Exact, log2HashmapSize).hashed);
    }
    EXPECT_FALSE(Level(2, HashRule::Exact, log2HashmapSize).hashed);
  }
}

} // namespace test::grid_index
