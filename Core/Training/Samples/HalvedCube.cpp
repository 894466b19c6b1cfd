// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/HalvedCube.h"

#include "Core/Training/Samples/Trilinear.h"

namespace inr {

namespace {

/// The longest axis of more than one voxel, or x where there is none.
int LongestAxis(const glm::i64vec3& dims, const glm::dvec3& size)
{
  int longest = -1;
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] > 1 && (longest < 0 || size[axis] > size[longest])) {
      longest = axis;
    }
  }
  return longest < 0 ? 0 : longest;
}

} // namespace

HalvedCube HalveAlong(const std::vector<int>& axes)
{
  HalvedCube cube;
  std::size_t bit = std::size_t{1} << axes.size();
  cube.corners.assign(bit, glm::vec3(0.0f));
  for (const int axis : axes) {
    bit /= 2;
    cube.extent[axis] /= 2;
    for (std::size_t k = 0; k < cube.corners.size(); ++k) {
      cube.corners[k][axis] += (k & bit) != 0 ? cube.extent[axis] : 0.0f;
    }
  }
  return cube;
}

HalvedCube HalveLongest(const glm::i64vec3& dims, const glm::dvec3& size, std::int64_t count)
{
  glm::dvec3 edges = size;
  std::vector<int> axes;
  for (std::int64_t boxes = 1; boxes < count; boxes *= 2) {
    axes.push_back(LongestAxis(dims, edges));
    edges[axes.back()] /= 2;
  }
  return HalveAlong(axes);
}

glm::vec3 PositionInBox(const glm::vec3& corner, const glm::vec3& extent, const glm::i64vec3& dims,
                        std::uint64_t stream, std::uint64_t drawn)
{
  glm::vec3 position;
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = CoordinateInBox(corner[axis], extent[axis], dims[axis], stream,
                                     3 * drawn + static_cast<std::uint64_t>(axis));
  }
  return position;
}

glm::vec3 VoxelCentre(const glm::vec3& position, const glm::i64vec3& dims)
{
  return {CentreOfVoxel(position.x, dims.x), CentreOfVoxel(position.y, dims.y),
          CentreOfVoxel(position.z, dims.z)};
}

} // namespace inr
