// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/Kernels/Selection.h"

#include <utility>

namespace inr {
namespace cuda {

/// Finds the first few of many entries on a machine (CUDA/Device/Machine.h), sorted.
template <class Machine> class Selector
{
public:
  /// Room for `most` of `count` entries, or fewer of fewer; SelectionBytes. `most`: at most
  /// MostSelected.
  Selector(const Machine& machine, std::int64_t count, std::int64_t most)
      : Survivors(machine.template allocate<RankEntry>(SelectionSurvivors(count, most))),
        SecondSurvivors(machine.template allocate<RankEntry>(
            SelectionSurvivors(SelectionSurvivors(count, most), most)))
  {}

  /// Begins to write the first `most` of `count` entries, None behind the last. `source`: see
  /// SelectFirst.
  template <class Source>
  void select(Machine& machine, const Source& source, std::int64_t count, std::int64_t most,
              RankEntry* selected) const
  {
    RankEntry* from = this->Survivors.data();
    RankEntry* other = this->SecondSurvivors.data();
    bool last = SelectionChunks(count) <= 1;
    Pass(machine, source, count, most, last ? selected : from);
    while (!last) {
      count = SelectionSurvivors(count, most);
      last = SelectionChunks(count) <= 1;
      Pass(machine, SelectedEntries{from}, count, most, last ? selected : other);
      std::swap(from, other);
    }
  }

private:
  template <class Source>
  static void Pass(Machine& machine, const Source& source, std::int64_t count, std::int64_t most,
                   RankEntry* selected)
  {
    const SelectFirst<Source> kernel{source, count, most, selected};
    machine.run(kernel, SelectionChunks(count) * SelectFirst<Source>::Threads,
                SelectionSharedBytes);
  }

  typename Machine::template Array<RankEntry> Survivors; ///< of a first pass; then turn by turn
  typename Machine::template Array<RankEntry> SecondSurvivors;
};

} // namespace cuda
} // namespace inr
