// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/BrickRun.h"

#include "Core/Inference/KernelTable.h"

#include <algorithm>
#include <limits>

namespace inr {

namespace {

VoxelBytes FormatOf(CachePrecision precision)
{
  switch (precision) {
  case CachePrecision::Float32:
    return VoxelBytes::Four;
  case CachePrecision::Bits16:
    return VoxelBytes::Two;
  default:
    return VoxelBytes::One;
  }
}

} // namespace

const BrickKernel& BrickKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Bricks); }

BrickSpan SpanAt(const Hierarchy& hierarchy, int level, const Ray& ray, double t)
{
  const Hierarchy::Location place = hierarchy.locate(level, ray.at(t));
  const glm::i64vec3& bricks = hierarchy.bricks(level);
  const glm::dvec3 stride(glm::max(hierarchy.brickDims() - 1, 1));
  const glm::dvec3 first(hierarchy.firstVoxel(place.brick));
  const glm::dvec3 begin = ray.entry * hierarchy.scale(level) + hierarchy.bias(level) - first;
  BrickSpan span{KeyOf(place.brick), 0.0, std::numeric_limits<double>::infinity(), {}, {}};
  span.direction = ray.direction * hierarchy.scale(level);
  for (int axis = 0; axis < 3; ++axis) {
    const double slope = span.direction[axis];
    if (slope == 0.0) {
      continue;
    }
    const bool hasLower = place.brick.at[axis] > 0;
    const bool hasUpper = place.brick.at[axis] + 1 < bricks[axis];
    const double toLower = -begin[axis] / slope;
    const double toUpper = (stride[axis] - begin[axis]) / slope;
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
                    const BrickView& view, const Hierarchy& hierarchy, CachePrecision precision)
{
  this->Level = level;
  this->Enter = std::max(wanted.enter, served.enter);
  this->Exit = std::min(wanted.exit, served.exit);
  this->Reference = served.enter;
  this->Exact = wanted.key == served.key;
  this->Wanted = wanted.key;
  this->Count = 0;
  this->Weight = 0;
  const BrickId id = IdOf(served.key);
  const glm::ivec3 dims = hierarchy.brickDims();
  const glm::i64vec3 inside = hierarchy.size(id.level) - std::int64_t{1} - hierarchy.firstVoxel(id);
  BrickPath& path = this->Path;
  path.voxels = view.voxels;
  path.format = FormatOf(precision);
  path.low = view.low;
  path.step = view.step;
  path.strideY = dims.x;
  path.strideZ = dims.x * dims.y;
  for (int axis = 0; axis < 3; ++axis) {
    path.lastCell[axis] = std::max(dims[axis] - 2, 0);
    path.last[axis] = static_cast<float>(std::min<std::int64_t>(dims[axis] - 1, inside[axis]));
    path.origin[axis] = static_cast<float>(served.origin[axis]);
    path.direction[axis] = static_cast<float>(served.direction[axis]);
  }
}

void BrickRun::resolve(const BrickKernel& kernel, float* values)
{
  float sampled[SampleBatch::Capacity];
  kernel.sample(this->Path, this->T, this->Count, sampled);
  for (int k = 0; k < this->Count; ++k) {
    values[this->Sample[k]] = sampled[k];
  }
  this->Count = 0;
  this->Weight = 0;
}

} // namespace inr
