// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

#include <cstdint>

namespace inr {

/// Streamwise wave numbers that all modes share: what makes rows cheap.
constexpr int ChannelWaves = 16;
/// Voxels of a row that are computed at once.
constexpr int ChannelTile = 64;

/// Complex numbers as two arrays. Of modes: number m = ChannelWaves * group + wave.
struct Phasors
{
  const double* cosines;
  const double* sines;
};

/// The sums over modes and waves, for one instruction set. No multiplication is fused with an
/// addition: every instruction set gives the same bits.
struct ChannelKernel
{
  /// Adds up the modes of each wave at one (y, z): what is left is, with the wave's phase p,
  /// row[wave] * cos(p) + row[ChannelWaves + wave] * sin(p). `plane` holds the modes' amplitudes
  /// and phases at z, `coarse` and `fine` their turns to y, one after the other.
  void (*collect)(Phasors plane, Phasors coarse, Phasors fine, int groups, double* row);

  /// ChannelTile values of such a row plus `mean`. `coarse` turns each wave to the tile's first
  /// voxel, `fine` (ChannelTile numbers for each wave) from there to every voxel.
  void (*tile)(const double* row, Phasors coarse, Phasors fine, double mean, double* values);
};

/// The kernel built for `set`, which must be usable.
const ChannelKernel& ChannelKernelFor(InstructionSet set);

namespace baseline {
extern const ChannelKernel Channel;
}
namespace avx2 {
extern const ChannelKernel Channel;
}
namespace avx512 {
extern const ChannelKernel Channel;
}

} // namespace inr
