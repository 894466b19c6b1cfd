// SPDX-License-Identifier: BSD-3-Clause
//
// Bricks of voxels by a rule, which costs less than a network, for a DeviceCache on the host.
#pragma once

#include "CUDA/Inference/BrickBatch.h"
#include "Core/Model/Model.h"
#include "Core/Random.h"
#include "Testing/CUDA/HostMachine.h"

#include <gtest/gtest.h>

#include <vector>

/// What makes quantisation hard: constant bricks, zeros of both signs, ranges narrower than any
/// quantum, and all of [0, 1].
inline float RuledVoxel(std::uint64_t brick, std::uint64_t voxel)
{
  const float unit = inr::RandomUnit(brick, voxel);
  switch (brick % 5) {
  case 0:
    return static_cast<float>(brick % 1000) / 1000;
  case 1:
    return voxel % 3 == 0 ? -0.0f : (voxel % 3 == 1 ? 0.0f : unit);
  case 2:
    return unit * 0x1p-140f;
  case 3:
    return 0.5f + unit * 0x1p-10f;
  default:
    return unit < 0.01f ? 0.0f : (unit > 0.99f ? 1.0f : unit);
  }
}

inline void RuledBrick(const inr::cuda::BrickJob& job, float* values)
{
  std::uint64_t brick = static_cast<std::uint64_t>(job.points);
  std::int64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    brick = inr::RandomBits(brick, static_cast<std::uint64_t>(job.firstVoxel[axis]));
    brick = inr::RandomBits(brick, static_cast<std::uint64_t>(job.levelSize[axis]));
    brick = inr::RandomBits(brick, static_cast<std::uint64_t>(job.inside[axis]));
    voxels *= job.voxels[axis];
  }
  for (std::int64_t k = 0; k < voxels; ++k) {
    values[k] = RuledVoxel(brick, static_cast<std::uint64_t>(k));
  }
}

/// The voxels of a brick, by what lists the jobs of other tests.
inline std::vector<float> RuledBrick(const inr::Hierarchy& levels, inr::BrickKey key)
{
  inr::cuda::BrickBatch batch;
  batch.append(levels, key, 0, levels.brickDims().z);
  std::vector<float> values(static_cast<std::size_t>(batch.values));
  RuledBrick(batch.jobs[0], values.data());
  return values;
}

/// By the first thread.
struct RuledBricks
{
  static constexpr int Threads = 32;

  const inr::cuda::BrickJob* jobs;
  const inr::cuda::BrickEnd* end;
  float* values;

  template <class Block> INR_HOST_DEVICE void operator()(Block& block) const
  {
    if (block.index() == 0) {
      block.threads([&](int thread) {
        if (thread == 0) {
          this->inferAll();
        }
      });
    }
  }

private:
  void inferAll() const
  {
    std::int64_t items = 0;
    std::int64_t written = 0;
    for (std::int64_t k = 0; k < this->end->jobs; ++k) {
      const inr::cuda::BrickJob& job = this->jobs[k];
      EXPECT_EQ(job.firstItem, items);
      EXPECT_EQ(job.firstValue, written);
      RuledBrick(job, this->values + job.firstValue);
      items += ItemsOf(job);
      written += std::int64_t{job.voxels[0]} * job.voxels[1] * job.voxels[2];
    }
    EXPECT_EQ(this->end->items, items);
    EXPECT_EQ(this->end->values, written);
  }
};

class RuledInference
{
public:
  static inr::ModelPointer source() { return nullptr; } // nothing is Core's to compute
  static std::int64_t bytes() { return 0; }

  template <class Machine>
  static void infer(Machine& machine, const inr::cuda::BrickJob* jobs,
                    const inr::cuda::BrickEnd* end, float* values)
  {
    machine.run(RuledBricks{jobs, end, values}, 1);
  }
};
