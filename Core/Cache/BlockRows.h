// SPDX-License-Identifier: BSD-3-Clause
//
// The voxels of some of a brick's blocks, row by row.
#pragma once

#include "Core/Cache/BlockSet.h"

#include <glm/gtc/type_precision.hpp>

#include <algorithm>
#include <cstdint>

namespace inr {

/// Some blocks of a brick whose last voxel inside of its level is `last`: none of those beyond it.
struct BlockRows
{
  const BlockSet& blocks;
  const BlockLattice& lattice;
  glm::ivec3 last;

  /// Of the blocks along x, those that have voxels of a row, bit by bit.
  unsigned at(int y, int z) const
  {
    const unsigned inside = (1u << (this->lattice.blocksAt(this->last.x, 0).last + 1)) - 1;
    return y > this->last.y ? 0 : this->blocks.rowOfVoxels(this->lattice, y, z) & inside;
  }

  /// Calls run(span of voxels along x) for the runs of such blocks.
  template <typename Run> void forEachRun(unsigned row, const Run& run) const
  {
    for (int first = 0; row >> first != 0; ++first) {
      if ((row >> first & 1u) != 0) {
        int end = first;
        while ((row >> (end + 1) & 1u) != 0) {
          ++end;
        }
        run(this->lattice.voxelsOf({first, end}, 0));
        first = end;
      }
    }
  }

  /// Calls body(span along x, span along y) so that each voxel of a layer's rows up to `last.y`
  /// that is in one of the blocks comes once.
  template <typename Body> void forEachRectangle(int z, const Body& body) const
  {
    for (int y = 0; y <= this->last.y;) {
      const int first = y;
      const unsigned row = this->at(first, z);
      while (y <= this->last.y && this->at(y, z) == row) {
        ++y;
      }
      this->forEachRun(row, [&](const BlockLattice::Span& x) {
        body(x, BlockLattice::Span{first, y - 1});
      });
    }
  }

  /// Of a whole brick, makes of all voxels up to layer `last.z` that are in none of the blocks what
  /// the first is that is in one.
  void fillRest(float* values) const
  {
    const float value = this->firstOf(values);
    const int width = this->lattice.lastVoxel.x + 1;
    for (int z = 0; z <= this->last.z; ++z) {
      for (int y = 0; y <= this->lattice.lastVoxel.y; ++y, values += width) {
        float* gap = values;
        this->forEachRun(this->at(y, z), [&](const BlockLattice::Span& x) {
          std::fill(gap, values + x.first, value);
          gap = values + x.last + 1;
        });
        std::fill(gap, values + width, value);
      }
    }
  }

private:
  /// 0 where there is none.
  float firstOf(const float* values) const
  {
    const int width = this->lattice.lastVoxel.x + 1;
    for (int z = 0; z <= this->last.z; ++z) {
      for (int y = 0; y <= this->lattice.lastVoxel.y; ++y, values += width) {
        const unsigned row = this->at(y, z);
        if (row != 0) {
          return values[this->lattice.edge * __builtin_ctz(row)];
        }
      }
    }
    return 0;
  }
};

} // namespace inr
