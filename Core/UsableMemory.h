// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace inr {

/// Bytes of memory that this machine has or, where that is less, that it lets this process have: by
/// control groups, or by a limit of its addresses (RLIMIT_AS, as `ulimit -v` sets it).
std::int64_t UsableMemory();

/// Bytes that the control groups of this process allow it, as batch systems and containers set
/// them: the least of all from its own up to the root, of version 2 (memory.max) or 1
/// (memory.limit_in_bytes; see cgroups(7)). Nothing where there is no such limit. `root`: of the
/// file system.
std::optional<std::int64_t> ControlGroupMemory(const std::filesystem::path& root = "/");

} // namespace inr
