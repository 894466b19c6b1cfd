// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Inference/HugePages.h"

#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace inr {

#ifdef __linux__
void PreferHugePages(const void* memory, std::size_t bytes)
{
  constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (bytes < 2 * page || begin >= end) {
    return;
  }
  auto* const whole = reinterpret_cast<void*>(begin);
  constexpr int collapse = 25; // MADV_COLLAPSE, since Linux 6.1: now, not some day
  if (madvise(whole, end - begin, MADV_HUGEPAGE) == 0) {
    static_cast<void>(madvise(whole, end - begin, collapse));
  }
}
#else
void PreferHugePages(const void*, std::size_t) {}
#endif

} // namespace inr
