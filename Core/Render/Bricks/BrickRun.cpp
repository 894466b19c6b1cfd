// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/BrickRun.h"

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
  served.findPath(this->Reference * step, step, this->Path);
  this->Path.voxels = view.voxels;
  this->Path.base = view.low;
  this->Path.quantum = view.step;
  this->Place = -1;
  this->Shown.kind = ShownBlocks::Kind::All;
}

} // namespace inr
