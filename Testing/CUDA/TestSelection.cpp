// SPDX-License-Identifier: BSD-3-Clause
//
// The tournament against sorting.
#include "CUDA/Cache/Selector.h"
#include "Core/Random.h"
#include "Testing/CUDA/HostMachine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace test::selection {

using inr::cuda::RankEntry;

/// All different; many have the same major, and some are none.
std::vector<RankEntry> RandomEntries(std::int64_t count)
{
  std::vector<RankEntry> entries;
  for (std::int64_t k = 0; k < count; ++k) {
    const std::uint64_t bits = inr::RandomBits(3, static_cast<std::uint64_t>(k));
    const RankEntry entry{bits % 97 << (bits % 2 * 40), bits << 32 | static_cast<std::uint64_t>(k)};
    entries.push_back(bits % 11 == 0 ? RankEntry::None() : entry);
  }
  return entries;
}

std::vector<RankEntry> Sorted(std::vector<RankEntry> entries, std::int64_t most)
{
  std::sort(entries.begin(), entries.end(),
            [](const RankEntry& a, const RankEntry& b) { return a.isBefore(b); });
  entries.resize(static_cast<std::size_t>(most), RankEntry::None());
  return entries;
}

/// Of one pass, of two, and of as many as make their survivors change places.
TEST(Selection, IsTheBeginningOfTheSorted)
{
  constexpr std::int64_t room = 9000;
  for (const HostLaunch& launch : {HostLaunch{3, false}, HostLaunch{2, true}, HostLaunch{1}}) {
    HostMachine machine(launch);
    for (const std::int64_t most : {1, 40, 1024}) {
      const inr::cuda::Selector<HostMachine> selector(machine, room, most);
      for (const std::int64_t count : {0, 1, 39, 2048, 2049, 5000, 9000}) {
        const std::vector<RankEntry> entries = RandomEntries(count);
        std::vector<RankEntry> selected(static_cast<std::size_t>(most));
        selector.select(machine, inr::cuda::SelectedEntries{entries.data()}, count, most,
                        selected.data());
        const std::vector<RankEntry> expected = Sorted(entries, most);
        for (std::size_t k = 0; k < expected.size(); ++k) {
          ASSERT_EQ(selected[k].major, expected[k].major) << count << " " << most << " " << k;
          ASSERT_EQ(selected[k].minor, expected[k].minor) << count << " " << most << " " << k;
        }
      }
    }
  }
}

} // namespace test::selection
