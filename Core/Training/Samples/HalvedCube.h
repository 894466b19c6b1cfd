// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace inr {

/// The unit cube in equal boxes, in an order that keeps neighbours together: halves of halves, bit
/// by bit of a box's number.
struct HalvedCube
{
  glm::vec3 extent{1.0f};         ///< of a box
  std::vector<glm::vec3> corners; ///< the lower one of every box; exact, as extents are

  std::int64_t count() const { return static_cast<std::int64_t>(this->corners.size()); }
};

/// The cube halved across each of these axes in turn: the first is the highest bit of a box's
/// number.
HalvedCube HalveAlong(const std::vector<int>& axes);

/// `count` boxes, a power of two, as near to cubes as halving allows where the unit cube has the
/// edges `size`; axes of which `dims` says 1 voxel are not divided.
HalvedCube HalveLongest(const glm::i64vec3& dims, const glm::dvec3& size, std::int64_t count);

/// A position in the box at `corner`, uniformly drawn by number `drawn` of the random stream; in
/// the middle of an axis of a single voxel, where nothing changes and nothing else is ever asked
/// for.
glm::vec3 PositionInBox(const glm::vec3& corner, const glm::vec3& extent, const glm::i64vec3& dims,
                        std::uint64_t stream, std::uint64_t drawn);

/// The centre of the voxel that a position in the unit cube lies in.
glm::vec3 VoxelCentre(const glm::vec3& position, const glm::i64vec3& dims);

} // namespace inr
