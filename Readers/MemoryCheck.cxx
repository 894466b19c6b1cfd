// SPDX-License-Identifier: BSD-3-Clause
#include "MemoryCheck.h"

#include "Core/Error.h"

#include <vtksys/SystemInformation.hxx>

std::int64_t PhysicalMemory()
{
  vtksys::SystemInformation system;
  return std::int64_t{1024} * static_cast<std::int64_t>(system.GetHostMemoryTotal());
}

void RequireMemory(double bytes, const std::string& what, const std::string& advice)
{
  const auto memory = static_cast<double>(PhysicalMemory());
  if (bytes > memory) {
    constexpr double mib = 1024.0 * 1024.0;
    throw inr::Error(inr::ErrorCode::TooLarge,
                     what + " take " + std::to_string(static_cast<long long>(bytes / mib)) +
                         " MiB and this machine has " +
                         std::to_string(static_cast<long long>(memory / mib)) + "; " + advice);
  }
}
