// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Inference/BrickBatch.h"

namespace inr {
namespace cuda {

void BrickBatch::append(const Hierarchy& levels, BrickKey key, std::int64_t z, std::int64_t layers)
{
  const BrickEnd end{static_cast<std::int64_t>(this->jobs.size()), this->items, this->values};
  const BrickJob job = JobOf(levels.view(), key, z, layers, end);
  this->items += ItemsOf(job);
  this->values += std::int64_t{job.voxels[0]} * job.voxels[1] * job.voxels[2];
  this->jobs.push_back(job);
}

} // namespace cuda
} // namespace inr
