// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace inr {

/// For messages: "5 MiB", rounded up.
inline std::string InMebibytes(std::int64_t bytes)
{
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MiB";
}

} // namespace inr
