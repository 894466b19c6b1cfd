// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/BrickGradients.h"

#include <algorithm>

namespace inr {

namespace {

/// Where along an axis a path's sample is in its brick; as the kernels clamp it.
float PlaceOn(const BrickPath& path, int axis, float along)
{
  return std::clamp(path.origin[axis] + along * path.direction[axis], 0.0f, path.last[axis]);
}

} // namespace

bool BrickGradients::crosses(const Move& move, BrickKey brick, float place) const
{
  const Hierarchy& hierarchy = this->Cache.hierarchy();
  const BrickId id = IdOf(brick);
  const float target = place + static_cast<float>(move.step);
  const auto stride = static_cast<float>(hierarchy.brickDims()[move.axis] - 1);
  return move.step < 0
             ? target < 0.0f && id.at[move.axis] > 0
             : target > stride && id.at[move.axis] + 1 < hierarchy.bricks(id.level)[move.axis];
}

bool BrickGradients::movePath(const Move& move, const Wish& wish, BrickKey brick, bool crosses,
                              BrickPath& path) const
{
  path.origin[move.axis] += static_cast<float>(move.step);
  if (!crosses) {
    return true;
  }
  const Hierarchy& hierarchy = this->Cache.hierarchy();
  BrickId next = IdOf(brick);
  next.at[move.axis] += move.step;
  const std::int32_t slot = this->Cache.find(KeyOf(next));
  if (slot < 0) {
    wish.requests.add(KeyOf(next), 1, wish.contribution);
    return wish.missing == Missing::OneSided;
  }
  this->Cache.touch(slot);
  const BrickView view = this->Cache.view(slot);
  path.voxels = view.voxels;
  path.base = view.low;
  path.quantum = view.step;
  const int dims = hierarchy.brickDims()[move.axis];
  path.origin[move.axis] -= static_cast<float>(move.step * (dims - 1));
  const std::int64_t voxels = (hierarchy.size(next.level) - hierarchy.firstVoxel(next))[move.axis];
  path.last[move.axis] = static_cast<float>(std::min<std::int64_t>(dims, voxels) - 1);
  return true;
}

int BrickGradients::moveSamples(const SampleBatch& batch, const BrickKey* bricks, const int* which,
                                int count, const Move& move, const Wish& wish)
{
  int paths = 0;
  int source = -1; // path of which the latest one was made
  bool crossing = false;
  for (int k = 0; k < count; ++k) {
    const int from = batch.path[which[k]];
    const float along = batch.along[which[k]];
    const float place = PlaceOn(batch.paths[from], move.axis, along);
    const bool crosses = this->crosses(move, bricks[from], place);
    if (from != source || crosses != crossing) {
      this->Moved.paths[paths] = batch.paths[from];
      if (!this->movePath(move, wish, bricks[from], crosses, this->Moved.paths[paths])) {
        return k;
      }
      source = from;
      crossing = crosses;
      ++paths;
    }
    const BrickPath& path = this->Moved.paths[paths - 1];
    const bool inside = !crosses || path.voxels == batch.paths[from].voxels;
    this->Moved.path[k] = paths - 1;
    this->Moved.along[k] = along;
    this->Offsets[k] =
        inside ? PlaceOn(path, move.axis, along) - place : static_cast<float>(move.step);
  }
  return count;
}

int BrickGradients::find(const SampleBatch& batch, const BrickKey* bricks, const int* which,
                         int count, Missing missing, float contribution, RequestList& requests,
                         glm::vec3* gradients)
{
  const Wish wish{missing, contribution, requests};
  for (int axis = 0; axis < 3; ++axis) {
    float values[SampleBatch::Capacity];
    float offsets[SampleBatch::Capacity];
    for (const int step : {-1, 1}) {
      count = this->moveSamples(batch, bricks, which, count, {axis, step}, wish);
      if (count == 0) {
        return 0;
      }
      this->Kernel.sample(this->Format, this->Moved, count);
      if (step < 0) {
        std::copy_n(this->Moved.value, count, values);
        std::copy_n(this->Offsets, count, offsets);
      }
    }
    for (int k = 0; k < count; ++k) {
      const int level = IdOf(bricks[batch.path[which[k]]]).level;
      const auto scale = static_cast<float>(this->Cache.hierarchy().scale(level)[axis]);
      const float length = this->Offsets[k] - offsets[k];
      const float difference = this->Moved.value[k] - values[k];
      gradients[k][axis] = length > 0.0f ? difference / length * scale : 0.0f;
    }
  }
  return count;
}

} // namespace inr
