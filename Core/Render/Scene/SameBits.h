// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstring>

namespace inr {

/// Whether two arrays of numbers are the same bit by bit: what is no number equals nothing, not
/// even itself, and a picture with one would never be known again.
template <class T> bool HaveSameBits(const T* a, const T* b, std::size_t count)
{
  return count == 0 || std::memcmp(a, b, count * sizeof(T)) == 0;
}

} // namespace inr
