// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Random.h"

#include <cstdint>

namespace inr {

/// What a training draws random numbers for, each from a stream of its own. The numbers are part of
/// what makes a training repeatable: they must not change.
enum class RandomStream : std::uint64_t {
  InitialParameters = 1,
  Batches = 2,
  Estimate = 3,      ///< voxels that PsnrEstimate looks at
  PoolPositions = 4, ///< samples of blocks
  PoolOrder = 5,     ///< in which blocks are read again
  Bars = 6,          ///< that quality is measured in
  KeptBlocks = 7     ///< that are looked at when a training goes on
};

/// The seed of a stream.
inline std::uint64_t StreamSeed(std::uint64_t seed, RandomStream stream)
{
  return RandomBits(seed, static_cast<std::uint64_t>(stream));
}

} // namespace inr
