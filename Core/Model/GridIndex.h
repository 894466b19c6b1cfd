// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Model/Description.h"

#include <cstdint>

namespace inr {

/// Factors of the hash functions that are a XOR of products.
struct HashPrimes
{
  std::uint32_t x, y, z;
};

/// tiny-cuda-nn's factors; meaningless for HashFunction::Rng.
INR_HOST_DEVICE constexpr HashPrimes PrimesOf(HashFunction function)
{
  switch (function) {
  case HashFunction::Prime:
    return {1958374283u, 2654435761u, 805459861u};
  case HashFunction::ReversedPrime:
    return {2165219737u, 1434869437u, 2097192037u};
  default:
    return {1u, 2654435761u, 805459861u};
  }
}

INR_HOST_DEVICE constexpr std::uint32_t HashCorner(HashPrimes primes, std::uint32_t x,
                                                   std::uint32_t y, std::uint32_t z)
{
  return (x * primes.x) ^ (y * primes.y) ^ (z * primes.z);
}

/// The `step`-th output of PCG32 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient
/// Statistically Good Algorithms for Random Number Generation", 2014) seeded with 1337, stream 1,
/// reached by Brown's logarithmic jump-ahead.
INR_HOST_DEVICE constexpr std::uint32_t Pcg32At(std::uint64_t step)
{
  constexpr std::uint64_t Multiplier = 0x5851F42D4C957F2Dull;
  constexpr std::uint64_t Increment = 3; // stream 1
  std::uint64_t state = (Increment + 1337u) * Multiplier + Increment;

  std::uint64_t multiplier = Multiplier;
  std::uint64_t increment = Increment;
  for (; step != 0; step >>= 1) {
    if ((step & 1) != 0) {
      state = state * multiplier + increment;
    }
    increment *= multiplier + 1;
    multiplier *= multiplier;
  }
  const auto shifted = static_cast<std::uint32_t>(((state >> 18) ^ state) >> 27);
  const auto rotation = static_cast<std::uint32_t>(state >> 59);
  return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
}

/// As above for any function. Rng packs 21 bits per axis into the number's position.
INR_HOST_DEVICE constexpr std::uint32_t HashCorner(HashFunction function, std::uint32_t x,
                                                   std::uint32_t y, std::uint32_t z)
{
  if (function == HashFunction::Rng) {
    return Pcg32At(std::uint64_t{x} ^ (std::uint64_t{y} << 21) ^ (std::uint64_t{z} << 42));
  }
  return HashCorner(PrimesOf(function), x, y, z);
}

/// Entry of lattice corner (x, y, z) in the table of `level`; x may be as large as the resolution
/// (the upper corner near u = 1), and then aliases as in tiny-cuda-nn.
INR_HOST_DEVICE constexpr std::uint32_t GridIndex(const GridLevel& level, HashFunction function,
                                                  std::uint32_t x, std::uint32_t y, std::uint32_t z)
{
  const std::uint32_t index = level.hashed
                                  ? HashCorner(function, x, y, z)
                                  : x * level.stride[0] + y * level.stride[1] + z * level.stride[2];
  return index % level.entries;
}

} // namespace inr
