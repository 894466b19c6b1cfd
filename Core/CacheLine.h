// SPDX-License-Identifier: BSD-3-Clause
//
// No functions in here: sources that are built once per instruction set include it.
#pragma once

namespace inr {

/// What processors read from memory at a time.
constexpr int CacheLineBytes = 64;
constexpr int CacheLineFloats = CacheLineBytes / static_cast<int>(sizeof(float));

} // namespace inr
