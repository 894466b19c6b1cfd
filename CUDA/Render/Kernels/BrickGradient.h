// SPDX-License-Identifier: BSD-3-Clause
//
// The gradient of the cached field at one sample, as Core/Render/Bricks/BrickGradients has it:
// central differences one voxel of the sampled level to either side, across the faces of bricks.
#pragma once

#include "CUDA/Render/Kernels/BrickReader.h"

namespace inr {
namespace cuda {

/// Where a sample stands that is moved by one voxel.
struct MovedSample
{
  float value;
  float offset; ///< by how many voxels it really was, at the rim of the volume
};

class GradientFinder
{
public:
  /// `contribution`: what each brick that is not there is worth.
  INR_HOST_DEVICE GradientFinder(const CacheView& cache, const BrickReader& reader, float along,
                                 OnMiss onMiss, float contribution)
      : Cache(cache), Reader(reader), Along(along), Missing(onMiss), Contribution(contribution)
  {}

  /// Per voxel of level 0. False where the ray stops for a brick.
  INR_HOST_DEVICE bool find(glm::vec3& gradient)
  {
    const int level = IdOf(this->Reader.served()).level;
    for (int axis = 0; axis < 3; ++axis) {
      MovedSample lower{};
      MovedSample upper{};
      if (!this->move(axis, -1, lower) || !this->move(axis, 1, upper)) {
        return false;
      }
      const auto scale = static_cast<float>(this->Cache.hierarchy.level(level).scale[axis]);
      const float length = upper.offset - lower.offset;
      gradient[axis] = length > 0.0f ? (upper.value - lower.value) / length * scale : 0.0f;
    }
    return true;
  }
  /// Neighbours that were not there.
  INR_HOST_DEVICE int missed() const { return this->Missed; }

private:
  INR_HOST_DEVICE bool move(int axis, int step, MovedSample& moved)
  {
    const float place = PlaceOn(this->Reader.path(), axis, this->Along);
    BrickPath path = this->Reader.path();
    path.origin[axis] += static_cast<float>(step);
    bool stays = true;
    if (this->crosses(axis, step, place) && !this->enterNext(axis, step, path, stays)) {
      return false;
    }
    moved.value = ValueOn(this->Cache, path, this->Along);
    moved.offset = stays ? PlaceOn(path, axis, this->Along) - place : static_cast<float>(step);
    return true;
  }

  /// Whether the move leads into another brick.
  INR_HOST_DEVICE bool crosses(int axis, int step, float place) const
  {
    const BrickId id = IdOf(this->Reader.served());
    if (step < 0) {
      return id.at[axis] > 0 && place < 1.0f;
    }
    const HierarchyView& levels = this->Cache.hierarchy;
    return id.at[axis] + 1 < levels.level(id.level).bricks[axis] &&
           place > static_cast<float>(levels.brickDims()[axis] - 2);
  }

  INR_HOST_DEVICE bool enterNext(int axis, int step, BrickPath& path, bool& stays)
  {
    BrickId next = IdOf(this->Reader.served());
    next.at[axis] += step;
    const std::int32_t slot = this->Cache.find(KeyOf(next));
    if (slot < 0) {
      this->Cache.request(KeyOf(next), this->Contribution);
      ++this->Missed;
      return this->Missing != OnMiss::Stop;
    }
    stays = false;
    this->Cache.touch(slot);
    const BrickView view = this->Cache.view(slot);
    path.voxels = view.voxels;
    path.base = view.low;
    path.quantum = view.step;
    const HierarchyView& levels = this->Cache.hierarchy;
    const int dims = levels.brickDims()[axis];
    path.origin[axis] -= static_cast<float>(step * (dims - 1));
    const std::int64_t voxels = levels.level(next.level).size[axis] - levels.firstVoxel(next)[axis];
    path.last[axis] = static_cast<float>((voxels < dims ? voxels : dims) - 1);
    return true;
  }

  const CacheView& Cache;
  const BrickReader& Reader;
  float Along;
  OnMiss Missing;
  float Contribution;
  int Missed = 0;
};

} // namespace cuda
} // namespace inr
