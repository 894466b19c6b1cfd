// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/MemoryCheck.h"

#include "Core/Error.h"
#include "Core/UsableMemory.h"

void RequireMemory(double bytes, const std::string& what, const std::string& advice)
{
  const auto memory = static_cast<double>(inr::UsableMemory());
  if (bytes > memory) {
    constexpr double mib = 1024.0 * 1024.0;
    throw inr::Error(inr::ErrorCode::TooLarge,
                     what + " take " + std::to_string(static_cast<long long>(bytes / mib)) +
                         " MiB and this process may have " +
                         std::to_string(static_cast<long long>(memory / mib)) + "; " + advice);
  }
}
