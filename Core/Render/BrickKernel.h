// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/InstructionSet.h"

#include <cstdint>

namespace inr {

/// Bytes of one stored voxel: float, or an integer of 16 or 8 bits.
enum class VoxelBytes { One = 1, Two = 2, Four = 4 };

/// A ray's way through one brick. Local coordinate at t: clamp(origin + t * direction, 0, last),
/// voxel i at i. Plain data.
struct BrickPath
{
  const void* voxels; ///< x fastest
  VoxelBytes format;
  float low; ///< value = low + step * stored
  float step;
  int strideY; ///< in voxels
  int strideZ;
  int lastCell[3]; ///< largest first corner of an interpolation cell
  float last[3];
  float origin[3];
  float direction[3];
};

/// Colours and opacities for the sample lengths of one frame: table + multiple * rows holds, for
/// samples of 2^multiple steps, `rows` entries of straight RGB and the opacity of the whole sample.
/// Entry 0 and 1 hold what is below the transfer function's range, the last two what is above.
struct StepLookup
{
  const float* entries; ///< RGBA
  int rows;
  float scale; ///< entry position = scale * y + bias
  float bias;
};

/// Samples of a ray, front to back.
struct SampleBatch
{
  static constexpr int Capacity = 32;
  float value[Capacity];
  float low[Capacity]; ///< range of the sample's macro-cell, to which its value is clamped
  float high[Capacity];
  std::int32_t multiple[Capacity]; ///< log2 of its length in steps
  float opacity[Capacity];         ///< out: accumulated before the sample
};

/// What a ray has gathered.
struct RayColor
{
  float rgb[3]; ///< premultiplied
  float transmittance;
};

/// The inner loops of cached ray marching, for one instruction set.
struct BrickKernel
{
  /// Trilinear values at t[0 .. count), count <= SampleBatch::Capacity; reads and writes up to the
  /// next multiple of 16.
  void (*sample)(const BrickPath& path, const float* t, int count, float* values);

  /// Composites `count` samples front to back until transmittance falls to `opaque`; returns how
  /// many were used. Adds to `clamped` those outside their range.
  int (*composite)(const StepLookup& lookup, SampleBatch& batch, int count, float opaque,
                   RayColor& color, std::int64_t& clamped);
};

/// The kernel built for `set`, which must be usable.
const BrickKernel& BrickKernelFor(InstructionSet set);

namespace baseline {
extern const BrickKernel Bricks;
}
namespace avx2 {
extern const BrickKernel Bricks;
}
namespace avx512 {
extern const BrickKernel Bricks;
}

} // namespace inr
