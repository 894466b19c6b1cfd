// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Common/MemoryCheck.h"

#include "Core/Error.h"
#include "Core/Mebibytes.h"
#include "Core/UsableMemory.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <new>

void RequireMemory(double bytes, const std::string& what, const std::string& advice)
{
  const std::int64_t memory = inr::UsableMemory();
  if (bytes > static_cast<double>(memory)) {
    const auto most = static_cast<double>(std::int64_t{1} << 62);
    throw inr::Error(
        inr::ErrorCode::TooLarge,
        what + " take " + inr::InMebibytes(static_cast<std::int64_t>(std::min(bytes, most))) +
            " and this process may have " + std::to_string(memory >> 20) + " MiB; " + advice);
  }
}

void RequireRoom(std::size_t bytes)
{
  void* volatile room = std::malloc(bytes); // volatile: else the compiler does without
  if (room == nullptr && bytes > 0) {
    throw std::bad_alloc();
  }
  std::free(room);
}
