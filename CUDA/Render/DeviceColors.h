// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Belongings.h"
#include "Core/Render/MacroCells/Majorants.h"

namespace inr {
namespace cuda {

/// Colours and the majorants that come of them, in a machine's memory.
template <class Machine> class DeviceColors
{
public:
  void set(Machine& machine, const Majorants& majorants, const ColorLookup& colors)
  {
    this->Arrays.clear();
    this->Lookup = colors;
    this->Lookup.entries = this->Arrays.put(machine, colors.entries, colors.count);
    this->Cells = MajorantsView();
    for (int k = 0; k < majorants.grids(); ++k) {
      const MajorantGridView& grid = majorants.view().grid(k);
      this->Cells.add({grid.dims(), grid.spacing(),
                       this->Arrays.put(machine, grid.ranges(), grid.count()),
                       this->Arrays.put(machine, grid.extinctions(), grid.count()),
                       this->Arrays.put(machine, grid.blocks(), grid.count())},
                      majorants.coarsestLevel(k));
    }
  }

  const ColorLookup& lookup() const { return this->Lookup; }
  const MajorantsView& majorants() const { return this->Cells; }

private:
  Belongings<Machine> Arrays;
  ColorLookup Lookup;
  MajorantsView Cells;
};

} // namespace cuda
} // namespace inr
