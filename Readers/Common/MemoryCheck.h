// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

/// Refuses what the machine cannot hold: the kernel would grant it and then end the process. Throws
/// inr::Error(TooLarge) for more bytes than inr::UsableMemory(): "`what` take ... MiB and this
/// process may have ... MiB; `advice`".
void RequireMemory(double bytes, const std::string& what, const std::string& advice);

/// For right before one of VTK's arrays takes so many bytes at once: VTK, as Debian builds it, ends
/// the process where there are none. Throws std::bad_alloc.
void RequireRoom(std::size_t bytes);
