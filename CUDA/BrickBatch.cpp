// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/BrickBatch.h"

#include <algorithm>

namespace inr {
namespace cuda {

void BrickBatch::append(const Hierarchy& levels, BrickKey key, std::int64_t z, std::int64_t layers)
{
  const BrickId id = IdOf(key);
  const glm::i64vec3 first = levels.firstVoxel(id);
  const glm::i64vec3& size = levels.size(id.level);
  BrickJob job{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t inside =
        std::min<std::int64_t>(levels.brickDims()[axis], size[axis] - first[axis]);
    const std::int64_t begin = axis == 2 ? std::min(z, inside - 1) : 0;
    const std::int64_t voxels = axis == 2 ? layers : levels.brickDims()[axis];
    job.firstVoxel[axis] = first[axis] + begin;
    job.levelSize[axis] = size[axis];
    job.voxels[axis] = static_cast<std::int32_t>(voxels);
    job.inside[axis] = static_cast<std::int32_t>(std::min(inside - begin, voxels));
  }
  job.points = id.level == 0 ? 1 : 2;
  job.firstItem = this->items;
  job.firstValue = this->values;
  this->items += ItemsOf(job);
  this->values += std::int64_t{job.voxels[0]} * job.voxels[1] * job.voxels[2];
  this->jobs.push_back(job);
}

} // namespace cuda
} // namespace inr
