// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/BrickGradients.h"

#include <algorithm>
#include <limits>

namespace inr {

namespace {

/// Where along an axis a path's sample is in its brick; as the kernels clamp it.
float PlaceOn(const BrickPath& path, int axis, float along)
{
  return std::clamp(path.origin[axis] + along * path.direction[axis], 0.0f, path.last[axis]);
}

} // namespace

BrickGradients::Inside BrickGradients::insideOf(BrickKey brick, const Move& move) const
{
  const Hierarchy& hierarchy = this->Bricks.cache().hierarchy();
  const BrickId id = IdOf(brick);
  const int last = hierarchy.brickDims()[move.axis] - 1;
  constexpr float everywhere = std::numeric_limits<float>::infinity();
  const bool hasLower = id.at[move.axis] > 0;
  const bool hasUpper = id.at[move.axis] + 1 < hierarchy.bricks(id.level)[move.axis];
  return {move.step < 0 && hasLower ? 1.0f : -everywhere,
          move.step > 0 && hasUpper ? static_cast<float>(last - 1) : everywhere};
}

bool BrickGradients::movePath(const Move& move, const Wish& wish, BrickKey brick, bool crosses,
                              BrickPath& path) const
{
  path.origin[move.axis] += static_cast<float>(move.step);
  if (!crosses) {
    return true;
  }
  const Hierarchy& hierarchy = this->Bricks.cache().hierarchy();
  BrickId next = IdOf(brick);
  next.at[move.axis] += move.step;
  const std::int32_t slot = this->Bricks.find(KeyOf(next));
  if (slot < 0) {
    wish.requests.add(KeyOf(next), wish.contribution);
    return wish.missing == Missing::OneSided;
  }
  this->Bricks.cache().touch(slot);
  const BrickView view = this->Bricks.cache().view(slot);
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
  Inside inside{};
  for (int k = 0; k < count; ++k) {
    const int from = batch.path[which[k]];
    const float along = batch.along[which[k]];
    const float place = PlaceOn(batch.paths[from], move.axis, along);
    if (from != source) {
      inside = this->insideOf(bricks[from], move);
    }
    const bool crosses = place < inside.low || place > inside.high;
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
    const bool stays = !crosses || path.voxels == batch.paths[from].voxels;
    this->Moved.path[k] = paths - 1;
    this->Moved.along[k] = along;
    this->Offsets[k] =
        stays ? PlaceOn(path, move.axis, along) - place : static_cast<float>(move.step);
  }
  return count;
}

int BrickGradients::find(const SampleBatch& batch, const BrickKey* bricks, const int* which,
                         int count, Missing missing, float contribution, RequestList& requests)
{
  const Wish wish{missing, contribution, requests};
  this->Kernel.differentiate(this->Format, batch, which, count, this->Latest);
  for (int axis = 0; axis < 3; ++axis) {
    int rims[SampleBatch::Capacity]; // of `which`
    int samples[SampleBatch::Capacity];
    int others = 0;
    for (int k = 0; k < count; ++k) {
      rims[others] = k;
      samples[others] = which[k];
      others += (this->Latest.inside[k] >> axis & 1) == 0 ? 1 : 0;
    }
    float found[SampleBatch::Capacity];
    const int known =
        others > 0 ? this->findAtRims(batch, bricks, samples, others, axis, wish, found) : 0;
    for (int k = 0; k < known; ++k) {
      this->Latest.along[axis][rims[k]] = found[k];
    }
    count = known < others ? rims[known] : count;
  }
  this->scaleToFinest(batch, bricks, which, count);
  this->Found += count;
  return count;
}

void BrickGradients::scaleToFinest(const SampleBatch& batch, const BrickKey* bricks,
                                   const int* which, int count)
{
  int source = -1;
  glm::vec3 scale(0.0f);
  for (int k = 0; k < count; ++k) {
    const int path = batch.path[which[k]];
    if (path != source) {
      scale = this->Bricks.cache().hierarchy().scale(IdOf(bricks[path]).level);
      source = path;
    }
    for (int axis = 0; axis < 3; ++axis) {
      this->Latest.along[axis][k] *= scale[axis];
    }
  }
}

int BrickGradients::findAtRims(const SampleBatch& batch, const BrickKey* bricks, const int* which,
                               int count, int axis, const Wish& wish, float* differences)
{
  float values[SampleBatch::Capacity] = {};
  float offsets[SampleBatch::Capacity] = {};
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
    const float length = this->Offsets[k] - offsets[k];
    differences[k] = length > 0.0f ? (this->Moved.value[k] - values[k]) / length : 0.0f;
  }
  return count;
}

} // namespace inr
