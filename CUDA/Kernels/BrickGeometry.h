// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <cstdint>

namespace inr {
namespace cuda {

/// Layers of a brick that are to be inferred. Its samples are the voxels' centres, or 2 x 2 x 2
/// points of each voxel, whose mean is its value.
struct BrickJob
{
  std::int64_t firstVoxel[3]; ///< in its level
  std::int64_t levelSize[3];  ///< voxels
  std::int32_t voxels[3];     ///< to be written, x fastest
  std::int32_t inside[3];     ///< at least 1; voxels from there on repeat the last one
  std::int32_t points;        ///< per voxel and axis: 1 or 2
  std::int64_t firstItem;     ///< of all jobs' items, see BrickItem
  std::int64_t firstValue;    ///< where its first voxel is written
};

/// Coordinate of a brick's k-th sample along an axis, as BrickSource places it; samples of voxels
/// that are not inside take the place of those of the last one.
INR_HOST_DEVICE inline float SampleCoordinate(const BrickJob& job, int axis, int k)
{
  const int voxel = k / job.points;
  const int kept = voxel < job.inside[axis] ? voxel : job.inside[axis] - 1;
  const double within = (static_cast<double>(kept * job.points + k % job.points) + 0.5) /
                        static_cast<double>(job.points);
  const double u = (static_cast<double>(job.firstVoxel[axis]) + within) /
                   static_cast<double>(job.levelSize[axis]);
  return static_cast<float>(u);
}

/// Side of the cube of samples that a block works on at once.
constexpr int ItemSize = 8;
constexpr int SamplesPerItem = ItemSize * ItemSize * ItemSize;

INR_HOST_DEVICE inline int ItemsAlong(const BrickJob& job, int axis)
{
  return (job.voxels[axis] * job.points + ItemSize - 1) / ItemSize;
}

INR_HOST_DEVICE inline std::int64_t ItemsOf(const BrickJob& job)
{
  return std::int64_t{1} * ItemsAlong(job, 0) * ItemsAlong(job, 1) * ItemsAlong(job, 2);
}

/// A cube of samples of a job.
struct BrickItem
{
  const BrickJob* job;
  int at[3]; ///< its place among the job's

  INR_HOST_DEVICE int firstSample(int axis) const { return this->at[axis] * ItemSize; }
};

/// `item` of those of `count` jobs, whose items follow each other.
INR_HOST_DEVICE inline BrickItem FindItem(const BrickJob* jobs, std::int64_t count,
                                          std::int64_t item)
{
  std::int64_t low = 0;
  for (std::int64_t high = count; high - low > 1;) {
    const std::int64_t middle = low + (high - low) / 2;
    (jobs[middle].firstItem <= item ? low : high) = middle;
  }
  const BrickJob& job = jobs[low];
  const int along[2] = {ItemsAlong(job, 0), ItemsAlong(job, 1)};
  const auto within = static_cast<std::int32_t>(item - job.firstItem);
  return {&job, {within % along[0], within / along[0] % along[1], within / (along[0] * along[1])}};
}

/// The network's output as Core's caches keep it; a NaN stays one.
INR_HOST_DEVICE inline float Normalised(float output)
{
  return output < 0.0f ? 0.0f : (output > 1.0f ? 1.0f : output);
}

} // namespace cuda
} // namespace inr
