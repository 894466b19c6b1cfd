// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/BlockGrid.h"

#include "Core/GridBox.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

/// Voxels that interpolation in a box of such edges, and a margin, reads at most.
std::int64_t VoxelsRead(const glm::i64vec3& dims, const glm::dvec3& edges, int margin)
{
  std::int64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    voxels *=
        std::min(dims[axis], static_cast<std::int64_t>(std::ceil(edges[axis])) + 2 + 2 * margin);
  }
  return voxels;
}

/// The axis to halve next: z or y, the longer one, as long as its halves are thick enough; then x,
/// then what is left. -1: there is nothing to be halved.
int NextAxis(const glm::dvec3& edges)
{
  const int longer = edges.z >= edges.y ? 2 : 1;
  for (const double thinnest : {static_cast<double>(BlockGrid::ThinnestBlock), 1.0}) {
    for (const int axis : {longer, 0}) {
      if (edges[axis] >= 2 * thinnest) {
        return axis;
      }
    }
  }
  return -1;
}

} // namespace

BlockGrid::BlockGrid(const glm::i64vec3& dims, std::int64_t mostVoxels, int margin)
    : Dims(dims), Margin(margin)
{
  glm::dvec3 edges(dims);
  while (VoxelsRead(dims, edges, margin) > mostVoxels) {
    const int axis = NextAxis(edges);
    if (axis < 0) {
      break;
    }
    edges[axis] /= 2;
    this->Axes.push_back(axis);
  }
  this->Boxes = HalveAlong(this->Axes);
}

std::int64_t BlockGrid::blockAt(const glm::vec3& position) const
{
  std::int64_t block = 0;
  glm::vec3 corner(0.0f);
  glm::vec3 edges(1.0f);
  for (const int axis : this->Axes) {
    edges[axis] /= 2;
    const bool upper = position[axis] >= corner[axis] + edges[axis];
    corner[axis] += upper ? edges[axis] : 0.0f;
    block = 2 * block + (upper ? 1 : 0);
  }
  return block;
}

std::pair<glm::dvec3, glm::dvec3> BlockGrid::edges(std::int64_t block) const
{
  const glm::dvec3 size(this->Dims);
  const glm::dvec3 low = glm::dvec3(this->corner(block)) * size - 0.5;
  return {low, low + glm::dvec3(this->extent()) * size};
}

GridBox BlockGrid::ownVoxels(std::int64_t block) const
{
  const auto [low, high] = this->edges(block);
  GridBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.first[axis] = static_cast<std::int64_t>(std::ceil(low[axis]));
    box.size[axis] = static_cast<std::int64_t>(std::ceil(high[axis])) - box.first[axis];
  }
  return box;
}

GridBox BlockGrid::voxels(std::int64_t block) const
{
  const auto [low, high] = this->edges(block);
  GridBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const auto first = static_cast<std::int64_t>(std::floor(low[axis]));
    const auto last = static_cast<std::int64_t>(std::floor(high[axis])) + 1;
    box.first[axis] = std::max<std::int64_t>(first, 0);
    box.size[axis] = std::min(last, this->Dims[axis] - 1) + 1 - box.first[axis];
  }
  return box;
}

double BlockGrid::readShare() const
{
  double voxels = 0;
  for (std::int64_t block = 0; block < this->count(); ++block) {
    const GridBox box = this->voxels(block);
    const glm::i64vec3 low = glm::max(box.first - std::int64_t{this->Margin}, glm::i64vec3(0));
    const glm::i64vec3 high = glm::min(box.end() + std::int64_t{this->Margin}, this->Dims);
    const glm::dvec3 read(high - low);
    voxels += GridCount(read);
  }
  const glm::dvec3 size(this->Dims);
  return voxels / GridCount(size);
}

} // namespace inr
