// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BlockLattice.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace inr {

/// Some of a brick's blocks. Plain data.
struct BlockSet
{
  static constexpr int Words = BlockLattice::Most;

  std::array<std::uint64_t, Words> words{}; ///< bit x + 8 y of word z is of block (x, y, z)

  /// Whatever the brick.
  static BlockSet all()
  {
    BlockSet set;
    set.words.fill(~std::uint64_t{0});
    return set;
  }

  void add(const glm::ivec3& block)
  {
    this->words[static_cast<std::size_t>(block.z)] |= bitOf(block);
  }
  bool has(const glm::ivec3& block) const
  {
    return (this->words[static_cast<std::size_t>(block.z)] & bitOf(block)) != 0;
  }
  bool contains(const BlockSet& other) const
  {
    return std::equal(this->words.begin(), this->words.end(), other.words.begin(),
                      [](std::uint64_t mine, std::uint64_t its) { return (its & ~mine) == 0; });
  }
  bool isAll() const
  {
    std::uint64_t common = ~std::uint64_t{0};
    for (const std::uint64_t word : this->words) { // asked for every sample of a path
      common &= word;
    }
    return common == ~std::uint64_t{0};
  }
  bool operator==(const BlockSet& other) const { return this->words == other.words; }

  /// Blocks (0, y, z), (1, y, z) ..., from the lowest bit on.
  std::uint8_t row(int y, int z) const
  {
    return static_cast<std::uint8_t>(this->words[static_cast<std::size_t>(z)] >>
                                     (BlockLattice::Most * y));
  }
  /// Such of all rows of blocks that share a row of voxels along x.
  std::uint8_t rowOfVoxels(const BlockLattice& lattice, int y, int z) const
  {
    const BlockLattice::Span rows = lattice.blocksAt(y, 1);
    const BlockLattice::Span layers = lattice.blocksAt(z, 2);
    return static_cast<std::uint8_t>(
        this->row(rows.first, layers.first) | this->row(rows.last, layers.first) |
        this->row(rows.first, layers.last) | this->row(rows.last, layers.last));
  }

private:
  static std::uint64_t bitOf(const glm::ivec3& block)
  {
    return std::uint64_t{1} << (block.x + BlockLattice::Most * block.y);
  }
};

} // namespace inr
