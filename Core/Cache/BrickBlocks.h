// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BlockLattice.h"
#include "Core/Cache/BlockSet.h"
#include "Core/Cache/BrickPool.h"
#include "Core/Model/MacroCells.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Of each slot of a cache, which blocks of its brick are known, and between which values the
/// voxels of each block are.
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
  /// From the voxels as they are stored. `known`: blocks whose voxels are the field's. `within`: as
  /// of BrickPool.
  void store(std::int32_t slot, const BrickView& brick, const BlockSet& known,
             const ValueRange& within = {});
  const BlockSet& known(std::int32_t slot) const { return this->Known[slot]; }
  /// Of all blocks, x fastest. Each end further out than need be by a code at most, and by half a
  /// quantum of integers and what interpolating rounds.
  void ranges(std::int32_t slot, ValueRange* ranges) const;

private:
  /// 256ths of the range that values are in: `within` or, where that is not known, the brick's own.
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
  void findCodes(const BrickView& brick, const ValueRange& within, std::int32_t slot);

  CachePrecision Precision;
  glm::ivec3 Dims;
  BlockLattice Lattice;
  ReservedArray<Codes> All;
  ReservedArray<Scale> Scales;
  ReservedArray<BlockSet> Known;
};

} // namespace inr
