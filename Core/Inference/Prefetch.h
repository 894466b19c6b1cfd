// SPDX-License-Identifier: BSD-3-Clause
//
// Fetching the next strip's table entries while this one's network runs; see Lanes.h for what may
// be in here. Tables of fine levels fit no cache, and a processor does not look that far ahead by
// itself.
#pragma once

#include "Core/Inference/EncodeGrid.h"

namespace inr {
namespace INR_ISA {

/// Spreads `units` calls of fetch(unit) evenly over `turns` calls of this.
template <class Fetch> class Evenly
{
public:
  Evenly(const Fetch& fetch, int units, int turns) : Function(fetch), Units(units), Turns(turns) {}

  void operator()()
  {
    if (this->Units > 0) {
      this->takeTurn();
    }
  }

private:
  /// Not inlined: the tiles around it need all registers.
  __attribute__((noinline)) void takeTurn()
  {
    this->Due += this->Units;
    for (; this->Due >= this->Turns; this->Due -= this->Turns) {
      this->Function(this->Next++);
    }
  }

  const Fetch& Function;
  int Units;
  int Turns;
  int Due = 0;
  int Next = 0;
};

/// True where a level's table is larger than what stays in a core's own cache beside the others.
inline bool IsFarAway(const LevelView& level, int features)
{
  constexpr std::uint64_t near = 512 << 10; // bytes
  return level.entries * static_cast<std::uint64_t>(features) * sizeof(float) > near;
}

inline bool HasFarLevels(const ModelView& model)
{
  for (int l = 0; l < model.levelCount; ++l) {
    if (IsFarAway(model.levels[l], model.features)) {
      return true;
    }
  }
  return false;
}

inline void PrefetchEntries(const float* table, int features, UInts entries, int count)
{
  std::uint32_t entry[LaneCount];
  std::memcpy(entry, &entries, sizeof(entries));
  for (int k = 0; k < count && k < LaneCount; ++k) {
    __builtin_prefetch(table + entry[k] * static_cast<std::uint64_t>(features), 0, 2);
  }
}

/// The corners of samples [first, first + LaneCount) of `count` on one level.
inline void PrefetchGroup(const ModelView& model, int level, const float* xyz, std::int64_t count,
                          std::int64_t first)
{
  const LevelView& view = model.levels[level];
  if (first >= count || !IsFarAway(view, model.features)) {
    return;
  }
  Corners corners;
  FindCorners(view, model.interpolation, LoadPositions(xyz + 3 * first, count - first), corners);
  for (const auto& entry : corners.entry) {
    UInts entries;
    std::memcpy(&entries, entry, sizeof(entries));
    PrefetchEntries(model.grid + view.offset, model.features, entries, LaneCount);
  }
}

/// What a piece will fetch of one level for `rows` rows; nothing where its samples share corners,
/// because then there is little to wait for.
inline void PrefetchRows(const ModelView& model, int level, const Coordinates& y, int rows,
                         const LevelPiece& piece)
{
  const LevelView& view = model.levels[level];
  if (piece.columnCount <= PieceWidth || !IsFarAway(view, model.features)) {
    return;
  }
  std::uint32_t cells[RowCapacity] = {};
  float weights[RowCapacity];
  LocateSome(view, model.interpolation, y, rows, cells, weights);
  std::uint32_t done = piece.lineY[0] > piece.lineY[1] ? piece.lineY[0] : piece.lineY[1];
  for (int line = 0; line < 2 * rows; ++line) {
    const std::uint32_t at = cells[line / 2] + static_cast<std::uint32_t>(line % 2);
    if (at <= done) { // heights rise
      continue;
    }
    done = at;
    for (int first = 0; first < piece.columnCount; first += LaneCount) {
      for (std::uint32_t z = piece.z; z <= piece.z + 1; ++z) {
        PrefetchEntries(model.grid + view.offset, model.features,
                        EntriesOfColumns(view, piece, first, at, z), piece.columnCount - first);
      }
    }
  }
}

} // namespace INR_ISA
} // namespace inr
