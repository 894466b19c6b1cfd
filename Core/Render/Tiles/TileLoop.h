// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>

namespace inr {

class Arena;

/// Throws Error(Cancelled) when `keepGoing`, which may be empty, says no.
void RequireGoing(const std::function<bool()>& keepGoing);

/// Calls `body` for tiles 0 ... count - 1, spread over the arena. `keepGoing` (may be empty) is
/// asked before each, possibly by several threads at once; when it answers false the rest is left
/// out and Error(Cancelled) thrown.
void ForEachTile(const Arena& arena, std::int64_t count, const std::function<bool()>& keepGoing,
                 const std::function<void(std::int64_t)>& body);

} // namespace inr
