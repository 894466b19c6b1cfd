// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Testing/Turbulence/ChannelKernel.h"

#include <cstdint>
#include <vector>

namespace inr {

/// cos and sin of the phases 2 pi n (i + 0.5)/N of waves at the voxels i of an axis, in two tables
/// whose turns add up: one for every tile of voxels, one for the voxels within a tile.
class PhaseTable
{
public:
  PhaseTable(const std::vector<int>& waves, std::int64_t voxels);

  /// Phases at the first voxel of the tile that `voxel` is in.
  Phasors coarse(std::int64_t voxel) const
  {
    return this->Coarse.row(voxel / ChannelTile, this->Waves);
  }
  /// What `voxel` adds to them.
  Phasors fine(std::int64_t voxel) const
  {
    return this->Fine.row(voxel % ChannelTile, this->Waves);
  }

private:
  struct Table
  {
    std::vector<double> cosines;
    std::vector<double> sines;

    void add(std::int64_t numerator, std::int64_t denominator);
    Phasors row(std::int64_t number, std::size_t waves) const
    {
      const std::size_t at = static_cast<std::size_t>(number) * waves;
      return {this->cosines.data() + at, this->sines.data() + at};
    }
  };

  std::size_t Waves;
  Table Coarse;
  Table Fine;
};

} // namespace inr
