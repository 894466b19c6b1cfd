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

} // namespace inr
