// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

/// Bytes of memory that this machine has.
std::int64_t PhysicalMemory();

/// Refuses what the machine cannot hold: the kernel would grant it and then end the process. Throws
/// inr::Error(TooLarge) for more bytes than the machine has memory: "`what` take ... MiB and this
/// machine has ... MiB; `advice`".
void RequireMemory(double bytes, const std::string& what, const std::string& advice);
