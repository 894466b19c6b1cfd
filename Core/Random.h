// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {

/// Counter-based random bits: the answer depends on (seed, counter) only, so any thread may ask for
/// any number in any order. The mixing is SplitMix64's finaliser (Steele, Lea and Flood, "Fast
/// splittable pseudorandom number generators", OOPSLA 2014), applied to seed and counter in turn.
INR_HOST_DEVICE inline std::uint64_t MixBits(std::uint64_t x)
{
  x += 0x9E3779B97F4A7C15ull;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
  return x ^ (x >> 31);
}

INR_HOST_DEVICE inline std::uint64_t RandomBits(std::uint64_t seed, std::uint64_t counter)
{
  return MixBits(MixBits(seed) ^ (counter * 0xD1342543DE82EF95ull));
}

/// Uniform in [0, 1) with 24 random bits: exact in float, never 1.
INR_HOST_DEVICE inline float RandomUnit(std::uint64_t seed, std::uint64_t counter)
{
  return static_cast<float>(RandomBits(seed, counter) >> 40) * 0x1p-24f;
}

/// The same of 32 bits, for what is drawn by the vector: an integer hash of two multiplications
/// ("lowbias32" of Wellons' hash prospector, 2018) of seed and counter.
INR_HOST_DEVICE inline float RandomUnit32(std::uint32_t seed, std::uint32_t counter)
{
  std::uint32_t x = seed ^ counter;
  x = (x ^ (x >> 16)) * 0x7FEB352Du;
  x = (x ^ (x >> 15)) * 0x846CA68Bu;
  return static_cast<float>((x ^ (x >> 16)) >> 8) * 0x1p-24f;
}

} // namespace inr
