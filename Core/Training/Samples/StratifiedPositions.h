// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Samples/HalvedCube.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Positions of mini-batches: one in each of `count` equal boxes that fill the unit cube, so that
/// every batch covers the volume evenly and its samples vary less than free ones would. Boxes come
/// in an order that keeps neighbours together (halves of halves), which is kind to the tables and
/// to the network: samples that lie together use the same entries and the same neurons.
///
/// Every second position is moved to the centre of its voxel: voxels are what a model is judged by
/// and what bricks are made of. The others keep what lies between them true.
class StratifiedPositions
{
public:
  /// `count` is a power of two. Boxes are as near to cubes as halving allows in voxels of `dims`;
  /// an axis of one voxel is not divided, and positions are in its middle.
  StratifiedPositions(const glm::i64vec3& dims, std::int64_t count);

  std::int64_t count() const { return this->Boxes.count(); }

  const HalvedCube& boxes() const { return this->Boxes; }

  /// The position in box k (0 to count() - 1) that number `drawn` of the random stream gives.
  glm::vec3 at(std::int64_t k, std::uint64_t stream, std::uint64_t drawn) const;

private:
  glm::i64vec3 Dims;
  HalvedCube Boxes;
};

} // namespace inr
