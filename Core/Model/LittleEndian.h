// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string>

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "model files are little-endian and are read and written as they lie in memory"
#endif

namespace inr {

/// The value whose bytes, of any alignment, are given.
template <typename T> T FromBytes(const void* bytes)
{
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

template <typename T> std::string ToBytes(const T& value)
{
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

} // namespace inr
