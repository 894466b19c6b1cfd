// SPDX-License-Identifier: BSD-3-Clause
//
// Up to 64 samples in a row, of which those are taken whose bit is set.
#pragma once

#include <cstdint>

namespace inr {

inline std::uint64_t LowestBits(int count)
{
  return count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
}

/// How many are set: what the compiler has for all processors is slower.
inline int CountBits(std::uint64_t bits)
{
  bits -= bits >> 1 & 0x5555555555555555;
  bits = (bits & 0x3333333333333333) + (bits >> 2 & 0x3333333333333333);
  bits = (bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0F;
  return static_cast<int>(bits * 0x0101010101010101 >> 56);
}

/// Of the bit before which `before` are set.
inline int PlaceOfBit(std::uint64_t bits, int before)
{
  for (int k = 0; k < before; ++k) {
    bits &= bits - 1;
  }
  return __builtin_ctzll(bits);
}

} // namespace inr
