// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/BrickRun.h"

#include "Core/Inference/KernelTable.h"

#include <algorithm>
#include <cmath>

namespace inr {

const BrickKernel& BrickKernelFor(InstructionSet set) { return INR_KERNEL_FOR(set, Bricks); }

BrickFormat FormatOf(const BrickCache& cache)
{
  const glm::ivec3& dims = cache.hierarchy().brickDims();
  const auto bytes = static_cast<VoxelBytes>(BytesPerVoxel(cache.precision()));
  const BlockLattice& blocks = cache.blocks().lattice();
  return {bytes,
          dims.x,
          dims.x * dims.y,
          {dims.x - 2, dims.y - 2, dims.z - 2},
          1.0f / static_cast<float>(blocks.edge),
          {blocks.count.x - 1, blocks.count.y - 1, blocks.count.z - 1}};
}

BrickWay::BrickWay(const Hierarchy& hierarchy, int level, const Ray& ray)
    : Level(level), Stride(hierarchy.brickDims() - 1),
      LastVoxel(hierarchy.size(level) - std::int64_t{1})
{
  const glm::dvec3& scale = hierarchy.brickScale(level);
  const glm::dvec3 start = ray.entry * scale + hierarchy.brickBias(level);
  this->Bricks =
      LatticeWalker(hierarchy.bricks(level), start, ray.direction * scale, ray.inverse / scale);
}

void BrickWay::findPath(const BrickView& view, double t, double step, BrickPath& path) const
{
  const glm::dvec3 cell(this->Bricks.cell());
  const glm::dvec3 origin = (this->Bricks.at(t) - cell) * this->Stride;
  const glm::dvec3 direction = this->Bricks.slope() * (this->Stride * step);
  const glm::dvec3 last = glm::min(this->Stride, this->LastVoxel - cell * this->Stride);
  path.voxels = view.voxels;
  path.base = view.low;
  path.quantum = view.step;
  for (int axis = 0; axis < 3; ++axis) {
    path.origin[axis] = static_cast<float>(origin[axis]);
    path.direction[axis] = static_cast<float>(direction[axis]);
    path.last[axis] = static_cast<float>(last[axis]);
  }
}

void BrickRun::open(const BrickWay& wanted, const BrickWay& served, const BrickView& view,
                    double step)
{
  const double inverse = 1.0 / step;
  this->Level = wanted.level();
  this->Enter = std::max(wanted.enter(), served.enter()) * inverse;
  this->Exit = std::min(wanted.exit(), served.exit()) * inverse;
  this->Reference = std::floor(served.enter() * inverse);
  this->Served = served.brick();
  this->ServedLevel = served.level();
  this->Wish = wanted.brick();
  this->Count = 0;
  served.findPath(view, this->Reference * step, step, this->Path);
  this->Place = -1;
  this->Shown.kind = ShownBlocks::Kind::All;
}

} // namespace inr
