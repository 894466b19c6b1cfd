// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/HierarchyView.h"
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
  bool flat[3];               ///< the volume has a single voxel, in whose middle they are
  std::int64_t firstItem;     ///< of all jobs' items, see BrickItem
  std::int64_t firstValue;    ///< where its first voxel is written
};

/// Coordinate of a brick's k-th sample along an axis, as LevelVoxels places it; samples of voxels
/// that are not inside take the place of those of the last one.
INR_HOST_DEVICE inline float SampleCoordinate(const BrickJob& job, int axis, int k)
{
  if (job.flat[axis]) {
    return 0.5f;
  }
  const int voxel = k / job.points;
  const int kept = voxel < job.inside[axis] ? voxel : job.inside[axis] - 1;
  const double within = (static_cast<double>(kept * job.points + k % job.points) + 0.5) /
                        static_cast<double>(job.points);
  const double u = (static_cast<double>(job.firstVoxel[axis]) + within) /
                   static_cast<double>(job.levelSize[axis]);
  return static_cast<float>(u);
}

/// Side of the cube of samples that a block works on at once.
constexpr int ItemPower = 3;
constexpr int ItemSize = 1 << ItemPower;
constexpr int SamplesPerItem = ItemSize * ItemSize * ItemSize;

INR_HOST_DEVICE inline int ItemsAlong(const BrickJob& job, int axis)
{
  return (job.voxels[axis] * job.points + ItemSize - 1) / ItemSize;
}

INR_HOST_DEVICE inline std::int64_t ItemsOf(const BrickJob& job)
{
  return std::int64_t{1} * ItemsAlong(job, 0) * ItemsAlong(job, 1) * ItemsAlong(job, 2);
}

/// Where a list of jobs ends.
struct BrickEnd
{
  std::int64_t jobs;
  std::int64_t items;  ///< of all of them
  std::int64_t values; ///< that they write
};

/// `layers` layers of a brick, from the `z`-th of its brickDims().z on, behind other jobs.
INR_HOST_DEVICE inline BrickJob JobOf(const HierarchyView& levels, BrickKey key, std::int64_t z,
                                      std::int64_t layers, const BrickEnd& end)
{
  const BrickId id = IdOf(key);
  const glm::i64vec3 first = levels.firstVoxel(id);
  const HierarchyLevel& level = levels.level(id.level);
  const glm::i64vec3& size = level.size;
  BrickJob job{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t dim = levels.brickDims()[axis];
    const std::int64_t inside = glm::min(dim, size[axis] - first[axis]);
    const std::int64_t begin = axis == 2 ? glm::min(z, inside - 1) : 0;
    const std::int64_t voxels = axis == 2 ? layers : dim;
    job.firstVoxel[axis] = first[axis] + begin;
    job.levelSize[axis] = size[axis];
    job.flat[axis] = levels.level(0).size[axis] == 1;
    job.voxels[axis] = static_cast<std::int32_t>(voxels);
    job.inside[axis] = static_cast<std::int32_t>(glm::min(inside - begin, voxels));
  }
  job.points = level.points;
  job.firstItem = end.items;
  job.firstValue = end.values;
  return job;
}

/// A cube of samples of a job.
struct BrickItem
{
  const BrickJob* job;
  int at[3]; ///< its place among the job's

  INR_HOST_DEVICE int firstSample(int axis) const { return this->at[axis] * ItemSize; }
};

/// `item` of all jobs', which is one of this job's.
INR_HOST_DEVICE inline BrickItem ItemOf(const BrickJob& job, std::int64_t item)
{
  const int along[2] = {ItemsAlong(job, 0), ItemsAlong(job, 1)};
  const auto within = static_cast<std::int32_t>(item - job.firstItem);
  return {&job, {within % along[0], within / along[0] % along[1], within / (along[0] * along[1])}};
}

/// `item` of those of `count` jobs, whose items follow each other.
INR_HOST_DEVICE inline BrickItem FindItem(const BrickJob* jobs, std::int64_t count,
                                          std::int64_t item)
{
  std::int64_t low = 0;
  for (std::int64_t high = count; high - low > 1;) {
    const std::int64_t middle = low + (high - low) / 2;
    (jobs[middle].firstItem <= item ? low : high) = middle;
  }
  return ItemOf(jobs[low], item);
}

/// The one behind `before`, number `item`, of jobs that end at `end`.
INR_HOST_DEVICE inline BrickItem NextItem(const BrickItem& before, const BrickJob* end,
                                          std::int64_t item)
{
  const BrickJob* const next = before.job + 1;
  return ItemOf(next < end && next->firstItem <= item ? *next : *before.job, item);
}

/// The network's output as Core's caches keep it; a NaN stays one.
INR_HOST_DEVICE inline float Normalised(float output)
{
  return output < 0.0f ? 0.0f : (output > 1.0f ? 1.0f : output);
}

} // namespace cuda
} // namespace inr
