// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/ReservedArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <unistd.h>

namespace test::reserved_array {

TEST(ReservedArray, KeepsItsElementsWhileItGrowsAndShrinks)
{
  inr::ReservedArray<std::int64_t> array(1 << 20);
  std::int64_t size = 0;
  for (const std::int64_t next : {100, 100000, 99999, 5000, 1 << 20, 700, 0, 3}) {
    for (std::int64_t k = 0; k < std::min(size, next); ++k) {
      ASSERT_EQ(array[k], 3 * k + 1);
    }
    array.resize(next);
    for (std::int64_t k = size; k < next; ++k) {
      array[k] = 3 * k + 1;
    }
    size = next;
    EXPECT_EQ(array.size(), next);
  }
}

#ifndef INR_SANITIZED // whose own memory counts
std::int64_t ResidentBytes()
{
  std::int64_t total = 0;
  std::int64_t resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

TEST(ReservedArray, TakesMemoryForWhatItHas)
{
  constexpr std::int64_t mebibyte = 1 << 20;
  const std::int64_t before = ResidentBytes();
  inr::ReservedArray<unsigned char> array(1024 * mebibyte);
  EXPECT_LT(ResidentBytes(), before + mebibyte);
  array.resize(64 * mebibyte);
  std::fill_n(array.data(), array.size(), 1);
  EXPECT_GT(ResidentBytes(), before + 60 * mebibyte);
  array.resize(8 * mebibyte + 1);
  EXPECT_LT(ResidentBytes(), before + 10 * mebibyte);
}
#endif

} // namespace test::reserved_array
