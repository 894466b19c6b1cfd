// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/MacroCells.h"
#include "Core/Parallel.h"
#include "Core/Training/Runtime/StateArray.h"
#include "Core/Training/Runtime/TrainingGroup.h"
#include "Core/Training/Volume/Volume.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace inr {

/// Voxels around a macro-cell whose values its range holds too: as far as samples of cache level 1
/// reach, which most pictures of a volume take many of. More would make ranges looser for all.
constexpr std::int64_t MacroCellApron = 3;

/// Smallest and largest value of every macro-cell with its apron, from boxes of voxels that come
/// in any order.
class CellRanges
{
public:
  struct Range
  {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void extend(const Range& other)
    {
      this->low = std::min(this->low, other.low);
      this->high = std::max(this->high, other.high);
    }
  };

  /// Cells of `edge` voxels over a volume of `dims` voxels.
  CellRanges(const glm::i64vec3& dims, int edge)
      : Dims(dims), Edge(edge), Cells(MakeMacroCells(dims, edge)), Ranges(this->Cells.ranges.size())
  {
    this->Cells.ranges = {}; // wanted in cells() only
  }

  /// Takes in the voxels of a box within a piece. A value that is not finite says that anything may
  /// be there.
  void add(const VolumePiece& piece, const GridBox& box, const Arena& arena);

  /// Where the ranges lie in memory.
  StateArray state()
  {
    return {"cells", this->Ranges.data(),
            static_cast<std::int64_t>(this->Ranges.size() * sizeof(Range))};
  }

  /// Takes in what others have.
  void gather(const TrainingGroup& group);

  /// The ranges in units in which `low` is 0 and `high` is 1, rounded outward, and `margin` wider
  /// to both sides; where anything may be, or nothing was taken in, 0 to 1.
  MacroCells cells(double low, double high, double margin, MacroCellProvenance provenance) const;

private:
  struct Span
  {
    std::int64_t begin;
    std::int64_t end;
  };

  template <class T>
  void addRows(const VolumePiece& piece, const T* values, const GridBox& box, const Arena& arena);

  /// Of an axis: the voxels in [begin, end) that cell `cell` and its apron hold, from the first.
  Span voxelsOf(std::int64_t cell, std::int64_t begin, std::int64_t end) const
  {
    return {std::max(begin, cell * this->Edge - MacroCellApron),
            std::min(end, (cell + 1) * this->Edge + MacroCellApron)};
  }
  /// Of an axis: the cells that hold one of the voxels [begin, end) or have it in their apron.
  Span cellsOf(std::int64_t begin, std::int64_t end, std::int64_t cells) const
  {
    return {std::max<std::int64_t>(0, begin - MacroCellApron) / this->Edge,
            std::min(cells, (end - 1 + MacroCellApron) / this->Edge + 1)};
  }

  glm::i64vec3 Dims;
  std::int64_t Edge;
  MacroCells Cells;
  std::vector<Range> Ranges;
};

} // namespace inr
