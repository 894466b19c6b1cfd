// SPDX-License-Identifier: BSD-3-Clause
#include "MemoryCheck.h"

#include "Core/Error.h"

#include <vtksys/SystemInformation.hxx>

void RequireMemory(double bytes, const std::string& what, const std::string& advice)
{
  vtksys::SystemInformation system;
  const double memory = 1024.0 * static_cast<double>(system.GetHostMemoryTotal());
  if (bytes > memory) {
    constexpr double mib = 1024.0 * 1024.0;
    throw inr::Error(inr::ErrorCode::TooLarge,
                     what + " take " + std::to_string(static_cast<long long>(bytes / mib)) +
                         " MiB and this machine has " +
                         std::to_string(static_cast<long long>(memory / mib)) + "; " + advice);
  }
}
