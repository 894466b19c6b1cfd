// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace inr {

/// Asks for large pages under memory that is read at random places all over, where the system has
/// such a thing: looking up a small page takes as long as reading it. Contents stay; a refusal
/// changes nothing. Does nothing for what caches hold anyway (below 4 MiB).
void PreferHugePages(const void* memory, std::size_t bytes);

} // namespace inr
