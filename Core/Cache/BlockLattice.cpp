// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BlockLattice.h"

#include <algorithm>

namespace inr {

namespace {

int EdgeOf(const glm::ivec3& brickDims)
{
  constexpr int least = 4;
  const int cells = std::max({brickDims.x, brickDims.y, brickDims.z}) - 1;
  return std::max(least, (cells + BlockLattice::Most - 1) / BlockLattice::Most);
}

} // namespace

BlockLattice::BlockLattice(const glm::ivec3& brickDims)
    : edge(EdgeOf(brickDims)), count((brickDims - 2 + this->edge) / this->edge),
      lastVoxel(brickDims - 1)
{}

} // namespace inr
