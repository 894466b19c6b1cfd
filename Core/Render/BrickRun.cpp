// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/BrickRun.h"

#include "Core/Inference/KernelTable.h"

#include <algorithm>
#include <limits>

namespace inr {

const BrickKernel& BrickKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Bricks); }

BrickFormat FormatOf(const BrickCache& cache)
{
  const glm::ivec3& dims = cache.hierarchy().brickDims();
  const auto bytes = static_cast<VoxelBytes>(BytesPerVoxel(cache.precision()));
  return {bytes, dims.x, dims.x * dims.y, {dims.x - 2, dims.y - 2, dims.z - 2}};
}

BrickSpan SpanAt(const Hierarchy& hierarchy, int level, const Ray& ray, double t)
{
  const BrickId brick = hierarchy.brickAt(level, ray.at(t));
  const glm::i64vec3& bricks = hierarchy.bricks(level);
  const glm::dvec3 stride(hierarchy.brickDims() - 1);
  const glm::dvec3 first(hierarchy.firstVoxel(brick));
  const glm::dvec3 begin = ray.entry * hierarchy.scale(level) + hierarchy.bias(level) - first;
  BrickSpan span{KeyOf(brick), 0.0, std::numeric_limits<double>::infinity(), {}, {}};
  span.direction = ray.direction * hierarchy.scale(level);
  const glm::dvec3 inverse = ray.inverse * hierarchy.inverseScale(level);
  for (int axis = 0; axis < 3; ++axis) {
    const double slope = span.direction[axis];
    if (slope == 0.0) {
      continue;
    }
    const bool hasLower = brick.at[axis] > 0;
    const bool hasUpper = brick.at[axis] + 1 < bricks[axis];
    const double toLower = -begin[axis] * inverse[axis];
    const double toUpper = (stride[axis] - begin[axis]) * inverse[axis];
    if (slope > 0 ? hasLower : hasUpper) {
      span.enter = std::max(span.enter, slope > 0 ? toLower : toUpper);
    }
    if (slope > 0 ? hasUpper : hasLower) {
      span.exit = std::min(span.exit, slope > 0 ? toUpper : toLower);
    }
  }
  span.origin = begin + span.enter * span.direction;
  return span;
}

void BrickRun::open(int level, const BrickSpan& wanted, const BrickSpan& served,
                    const BrickView& view, const Hierarchy& hierarchy)
{
  this->Level = level;
  this->Enter = std::max(wanted.enter, served.enter);
  this->Exit = std::min(wanted.exit, served.exit);
  this->Reference = served.enter;
  this->Exact = wanted.key == served.key;
  this->Served = served.key;
  this->Wish = wanted.key;
  this->Count = 0;
  this->Path.voxels = view.voxels;
  this->Path.base = view.low;
  this->Path.quantum = view.step;
  const BrickId id = IdOf(served.key);
  const glm::i64vec3 data = hierarchy.size(id.level) - hierarchy.firstVoxel(id);
  const glm::ivec3& dims = hierarchy.brickDims();
  for (int axis = 0; axis < 3; ++axis) {
    this->Path.origin[axis] = static_cast<float>(served.origin[axis]);
    this->Path.direction[axis] = static_cast<float>(served.direction[axis]);
    const std::int64_t last = std::min<std::int64_t>(dims[axis], data[axis]) - 1;
    this->Path.last[axis] = static_cast<float>(last);
  }
}

} // namespace inr
