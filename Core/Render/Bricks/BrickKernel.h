// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/CacheLine.h"
#include "Core/Inference/InstructionSet.h"
#include "Core/Render/Bricks/BrickPath.h"
#include "Core/Render/Marching/ColorLookups.h"
#include "Core/Render/Marching/DirectionalLights.h"

#include <cstdint>

namespace inr {

/// Bytes of one stored voxel: float, or an integer of 16 or 8 bits.
enum class VoxelBytes { One = 1, Two = 2, Four = 4 };

/// A value off its range by less than this is the storage format's rounding, not a broken bound.
constexpr float RoundingOfStorage = 0x1p-14f;

/// What all bricks of a cache have in common. Plain data.
struct BrickFormat
{
  VoxelBytes bytes;
  int strideY; ///< in voxels
  int strideZ;
  int lastCell[3];      ///< largest first corner of an interpolation cell
  float blocksPerVoxel; ///< see BlockLattice
  int lastBlock[3];
};

/// Which blocks of a brick may be seen; see BlockLattice. Plain data.
struct ShownBlocks
{
  enum class Kind : std::uint8_t { None, Some, All };
  static constexpr int Words = 8;

  Kind kind = Kind::All;
  std::uint64_t words[Words] = {}; ///< of Some: bit x + 8 y of word z is of block (x, y, z)
};

/// Samples on a ray's way through a brick: sample k is (start + k * spacing) + offset along it.
struct SampleRow
{
  static constexpr int Most = 64; ///< samples, a bit for each

  float start;
  float spacing; ///< in steps
  float offset;
};

/// Samples of a ray that differ in nothing but their place, in a brick or, chosen at random as
/// LevelOfDetail does, in one of two of neighbouring levels: sample k is
/// (start + k * spacing) + offset along its path, exactly that wherever the run begins.
struct SampleRun
{
  float start[2]; ///< on either path
  float spacing;  ///< in steps
  float offset;
  int ways;       ///< 1, or 2 where levels are dithered
  int path[2];    ///< in SampleBatch::paths: of the finer level and of the coarser one
  float fraction; ///< of the samples where the finer path begins that are on the coarser one
  float growth;   ///< of that, per step
  std::uint32_t seed;
  std::uint32_t counter; ///< of the first sample
  std::uint32_t stride;  ///< of the counters
  int count;             ///< taken, at most SampleRow::Most
  std::uint64_t shown;   ///< bit k: whether sample k of them is taken, as `count` are
  int length;            ///< what each stands for, see StepLookup
  float low;             ///< range of their macro-cell, to which values are clamped
  float high;
};

/// Samples of a ray, front to back. The arrays have room for kernels to write past the last sample.
struct SampleBatch
{
  static constexpr int Capacity = 128;
  static constexpr int Room = Capacity + CacheLineFloats;
  static_assert(Room % CacheLineFloats == 0, "arrays begin at cache lines");
  BrickPath paths[2 * Capacity + 2];
  SampleRun runs[Capacity];
  /// Of each sample, in `paths`. The array begins at a cache line, and so do those that follow, as
  /// Room is a whole number of lines.
  alignas(CacheLineBytes) std::int32_t path[Room];
  float along[Room]; ///< its path
  float low[Room];   ///< see SampleRun
  float high[Room];
  std::int32_t length[Room];
  float value[Room];   ///< out of `sample` and `sampleRuns`
  float begin[Room];   ///< for `compositeIntegrated`: value where what the sample stands for begins
  float opacity[Room]; ///< out of `composite`: accumulated before the sample
};

/// Of samples, how the field differs along the axes.
struct GradientBatch
{
  /// Out of `differentiate`, per voxel of the sample's level.
  alignas(CacheLineBytes) float along[3][SampleBatch::Room];
  /// Bit a: all that takes along axis a is in the sample's brick. Else `along` says nothing there.
  std::int32_t inside[SampleBatch::Room];
};

/// Of samples, the light on them: colour * factor + added.
struct LightBatch
{
  alignas(CacheLineBytes) float factor[3][SampleBatch::Room];
  float added[3][SampleBatch::Room];
};

/// What a ray has gathered.
struct RayColor
{
  double rgb[3]; ///< premultiplied
  double transmittance;
  /// More samples than float sums are good for: n of them lose up to n 2^-25 of all light.
  bool ofMany = false;
};
constexpr double ManySamples = 1 << 14;

/// The inner loops of cached ray marching, for one instruction set.
struct BrickKernel
{
  /// Which samples of a ray may show something: bit k is of the one at (start + k * spacing) +
  /// offset along its path, for k below `count`, at most SampleRow::Most; others are 0.
  std::uint64_t (*findShown)(const BrickFormat& format, const ShownBlocks& blocks,
                             const BrickPath& path, const SampleRow& row, int count);

  /// The same of the first `count` samples of a run that is on two paths, from the bricks of
  /// `blocks`: each is looked up where it is.
  std::uint64_t (*findShownOnTwo)(const BrickFormat& format, const ShownBlocks* const (&blocks)[2],
                                  const BrickPath* const (&paths)[2], const SampleRun& run,
                                  int count);

  /// Lays out the samples of the first `runs` runs, at most Capacity in all, and finds their
  /// values.
  void (*sampleRuns)(const BrickFormat& format, SampleBatch& batch, int runs);

  /// Finds the trilinear values of the first `count` samples, by `path` and `along`.
  void (*sample)(const BrickFormat& format, SampleBatch& batch, int count);

  /// Central differences, one voxel to either side, of samples which[0 .. count), which rise, of a
  /// batch.
  void (*differentiate)(const BrickFormat& format, const SampleBatch& batch, const int* which,
                        int count, GradientBatch& gradients);

  /// Straight RGB, and the opacity of all that a sample stands for, of the first `count` samples,
  /// which are in their ranges: four numbers each.
  void (*findColors)(const StepLookup& lookup, const SampleBatch& batch, int count, float* colors);

  /// Lights the first `count` samples by their gradients per voxel of level 0, seen from a world
  /// unit vector's direction. Where gradients tell no direction, there is ambient light only. Of
  /// the light, `factor` is off by some 2^-20 at most, `added` by that times the specular power.
  void (*light)(const DirectionalLights& lights, const float (&toEye)[3],
                const GradientBatch& gradients, int count, LightBatch& light);

  /// Composites `count` samples front to back until transmittance falls to `opaque`; returns how
  /// many were used. Adds to `clamped` those outside their range.
  int (*composite)(const StepLookup& lookup, SampleBatch& batch, int count, float opaque,
                   RayColor& color, std::int64_t& clamped);

  /// The same of samples [first, end), each of which has the colours of all values from `begin` to
  /// `value`, which is in its range.
  int (*compositeIntegrated)(const IntegralLookup& lookup, SampleBatch& batch, int first, int end,
                             float opaque, RayColor& color);
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
