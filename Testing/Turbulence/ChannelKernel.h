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

/// Points that are computed at once.
constexpr int ChannelPoints = 16;

/// A mode as scattered points want it, phases in turns: of the field's waves a turn is 2 pi.
struct PointMode
{
  double nx;
  double ny;
  double phase;
  double vertical; ///< turns per unit of PointPlaces::stretched
  double along;    ///< turns back per unit of PointPlaces::distance
  double across;
  double amplitude;
};

/// ChannelPoints points: x and y in the unit cube, and what their heights make of modes (see
/// TurbulentChannel::Height).
struct PointPlaces
{
  double x[ChannelPoints];
  double y[ChannelPoints];
  double distance[ChannelPoints];
  double stretched[ChannelPoints];
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

  /// The sums of `count` modes at ChannelPoints points, before TurbulentChannel::Height's strength.
  void (*points)(const PointMode* modes, int count, const PointPlaces& places, double* sums);
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
