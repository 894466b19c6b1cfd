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
  constexpr std::size_t page = std::size_t{2} << 20;
  // Whole pages only: what lies beside the memory is not ours.
  const std::size_t before = (page - reinterpret_cast<std::uintptr_t>(memory) % page) % page;
  if (bytes < 2 * page) {
    return;
  }
  const std::size_t whole = (bytes - before) / page * page;
  void* const begin = static_cast<char*>(const_cast<void*>(memory)) + before;
  constexpr int collapse = 25; // MADV_COLLAPSE, since Linux 6.1: now, not some day
  if (madvise(begin, whole, MADV_HUGEPAGE) == 0) {
    static_cast<void>(madvise(begin, whole, collapse));
  }
}
#else
void PreferHugePages(const void*, std::size_t) {}
#endif

} // namespace inr
