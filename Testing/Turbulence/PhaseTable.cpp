// SPDX-License-Identifier: BSD-3-Clause
#include "Testing/Turbulence/PhaseTable.h"

#include <algorithm>
#include <cmath>

namespace inr {

PhaseTable::PhaseTable(const std::vector<int>& waves, std::int64_t voxels) : Waves(waves.size())
{
  for (std::int64_t first = 0; first < voxels; first += ChannelTile) {
    for (const int wave : waves) {
      this->Coarse.add(wave * (2 * first + 1), 2 * voxels);
    }
  }
  for (std::int64_t offset = 0; offset < ChannelTile; ++offset) {
    for (const int wave : waves) {
      this->Fine.add(wave * offset, voxels);
    }
  }
}

// Whole turns are taken off in integers, so that the phase is exact but for one rounding.
void PhaseTable::Table::add(std::int64_t numerator, std::int64_t denominator)
{
  constexpr double twoPi = 6.283185307179586;
  const double turns =
      static_cast<double>(numerator % denominator) / static_cast<double>(denominator);
  this->cosines.push_back(std::cos(twoPi * turns));
  this->sines.push_back(std::sin(twoPi * turns));
}

} // namespace inr
