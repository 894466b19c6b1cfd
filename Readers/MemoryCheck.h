// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

/// Refuses what the machine cannot hold: the kernel would grant it and then end the process. Throws
/// inr::Error(TooLarge) for more bytes than inr::UsableMemory(): "`what` take ... MiB and this
/// process may have ... MiB; `advice`".
void RequireMemory(double bytes, const std::string& what, const std::string& advice);
