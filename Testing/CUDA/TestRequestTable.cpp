// SPDX-License-Identifier: BSD-3-Clause
//
// Wishes of many threads against a map of sums.
#include "CUDA/Cache/Kernels/CacheTables.h"
#include "Testing/CUDA/AskFor.h"
#include "Testing/CUDA/HostMachine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

namespace test::request_table {

using inr::BrickKey;
using inr::cuda::RequestTable;
using Sums = std::map<BrickKey, std::uint64_t>;

/// A cache that maps nothing.
class Requests
{
public:
  Requests(const HostLaunch& launch, std::int64_t entries)
      : Where(launch), Page(this->Where.allocate<inr::cuda::PageEntry>(1)),
        Entries(this->Where.allocate<inr::cuda::RequestEntry>(entries)),
        Counts(this->Where.allocate<inr::cuda::RequestCounts>(1))
  {
    this->Cache.pages = this->Page.data();
    this->Cache.requests = {this->Entries.data(), static_cast<std::uint32_t>(entries - 1),
                            this->Counts.data()};
    this->clear();
  }

  void clear() { this->Where.run(inr::cuda::ClearRequests{this->Cache.requests}, 1); }
  void ask(const std::vector<Wish>& wishes) { Ask(this->Where, this->Cache, wishes); }
  const inr::cuda::RequestCounts& counts() const { return *this->Counts.data(); }
  Sums sums() const
  {
    Sums sums;
    for (std::int64_t k = 0; k < this->Entries.size(); ++k) {
      const inr::cuda::RequestEntry& entry = this->Entries.data()[k];
      if (entry.key != inr::cuda::NoBrick) {
        EXPECT_TRUE(sums.emplace(entry.key, entry.contribution).second) << "entered twice";
      }
    }
    return sums;
  }

private:
  HostMachine Where;
  HostMachine::Array<inr::cuda::PageEntry> Page;
  HostMachine::Array<inr::cuda::RequestEntry> Entries;
  HostMachine::Array<inr::cuda::RequestCounts> Counts;
  inr::cuda::CacheView Cache{};
};

std::vector<HostLaunch> Launches() { return {{3, false}, {3, true}, {1, false}, {7, true}}; }

/// Of so many different bricks.
std::vector<Wish> RandomWishes(std::int64_t count, std::uint64_t bricks)
{
  std::vector<Wish> wishes;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::uint64_t bits = inr::RandomBits(5, static_cast<std::uint64_t>(k));
    const std::uint64_t brick = inr::RandomBits(6, bits % bricks);
    wishes.push_back({brick >> 2, inr::RandomUnit(7, bits) * 40});
  }
  return wishes;
}

Sums SumsOf(const std::vector<Wish>& wishes)
{
  Sums sums;
  for (const Wish& wish : wishes) {
    sums[wish.key] += RequestTable::Amount(wish.contribution);
  }
  return sums;
}

TEST(RequestTable, AddsUpByBrickInAnyOrder)
{
  const std::vector<Wish> wishes = RandomWishes(20000, 500);
  const Sums expected = SumsOf(wishes);
  for (const HostLaunch& launch : Launches()) {
    Requests requests(launch, 1024);
    for (int round = 0; round < 2; ++round) {
      requests.ask(wishes);
      EXPECT_EQ(requests.sums(), expected);
      EXPECT_EQ(requests.counts().bricks, expected.size());
      EXPECT_EQ(requests.counts().overflowed, 0u);
      requests.clear();
    }
    EXPECT_TRUE(requests.sums().empty());
    EXPECT_EQ(requests.counts().bricks, 0u);
  }
}

TEST(RequestTable, CountsWhatItHasNoRoomFor)
{
  const std::vector<Wish> wishes = RandomWishes(5000, 300);
  const Sums all = SumsOf(wishes);
  for (const HostLaunch& launch : Launches()) {
    for (const std::int64_t entries : {1, 64, 128}) {
      Requests requests(launch, entries);
      requests.ask(wishes);
      const Sums kept = requests.sums();
      EXPECT_EQ(requests.counts().bricks, kept.size());
      EXPECT_GT(requests.counts().overflowed, 0u);
      EXPECT_GT(static_cast<std::int64_t>(kept.size()), entries / 2);
      for (const auto& [key, sum] : kept) {
        EXPECT_EQ(sum, all.at(key));
      }
    }
  }
}

TEST(RequestTable, TakesAnyContribution)
{
  Requests requests({}, 64);
  const float infinity = std::numeric_limits<float>::infinity();
  const float step = std::ldexp(1.0f, -RequestTable::FractionBits);
  requests.ask({{1, NAN}, {2, -1.0f}, {3, infinity}, {4, 1e30f}, {5, step}, {5, 1.0f}, {6, -0.0f}});
  const std::uint64_t most = std::uint64_t{4096} << RequestTable::FractionBits;
  const std::uint64_t one = std::uint64_t{1} << RequestTable::FractionBits;
  EXPECT_EQ(requests.sums(), (Sums{{1, 0}, {2, 0}, {3, most}, {4, most}, {5, one + 1}, {6, 0}}));
}

/// 2^23 times the most is where sums end.
TEST(RequestTable, SumsDoNotWrap)
{
  Requests requests({}, 64);
  const std::vector<Wish> wishes(1 << 18, Wish{1, 1e9f});
  std::uint64_t before = 0;
  for (int round = 0; round < 40; ++round) {
    requests.ask(wishes);
    const std::uint64_t sum = requests.sums().at(1);
    EXPECT_EQ(sum > before, round < 32) << round;
    before = sum;
  }
  EXPECT_EQ(before, RequestTable::Saturated);
}

} // namespace test::request_table
