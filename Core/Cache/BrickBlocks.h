// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickPool.h"
#include "Core/Model/Model.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// How the interpolation cells of a brick make blocks: cubes of `edge` cells per side, fewer at the
/// far ends. Neighbouring blocks share the voxels between them, so that what is interpolated
/// anywhere in a block is within the range of its voxels.
struct BlockLattice
{
  static constexpr int Most = 8; ///< blocks per axis

  /// `brickDims`: voxels per axis, at least 2.
  explicit BlockLattice(const glm::ivec3& brickDims);

  int edge;         ///< at least 4, so that ranges take little beside the voxels
  glm::ivec3 count; ///< of blocks per axis

  std::int64_t blocks() const
  {
    return std::int64_t{1} * this->count.x * this->count.y * this->count.z;
  }
};

/// Of each slot of a cache, between which values the voxels of each block are.
class BrickBlocks
{
public:
  /// Addresses for `room` slots, of which there are none yet.
  BrickBlocks(CachePrecision precision, const glm::ivec3& brickDims, std::int64_t room);

  static std::int64_t bytesPerSlot(const glm::ivec3& brickDims);

  const BlockLattice& lattice() const { return this->Lattice; }
  /// `slots`: no more than there is room for. The memory of those that go is given back.
  void resize(std::int64_t slots);
  void copy(std::int32_t from, std::int32_t to);
  /// From the voxels as they are stored.
  void store(std::int32_t slot, const BrickView& brick);
  /// Of all blocks, x fastest. Wider than need be by a 256th of the brick's range at most, by half
  /// a quantum of integers, and by what interpolating rounds.
  void ranges(std::int32_t slot, ValueRange* ranges) const;

private:
  /// 256ths of the range of the brick's voxels.
  struct Codes
  {
    std::uint8_t low, high;
  };
  struct Scale
  {
    float low;
    float step; ///< of a code
  };

  Codes* codes(std::int32_t slot) const { return this->All.data() + slot * this->Lattice.blocks(); }
  template <typename Stored>
  void findCodes(const Stored* voxels, const BrickView& brick, std::int32_t slot);

  CachePrecision Precision;
  glm::ivec3 Dims;
  BlockLattice Lattice;
  ReservedArray<Codes> All;
  ReservedArray<Scale> Scales;
};

} // namespace inr
