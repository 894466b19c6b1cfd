// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Quality/CellRanges.h"

#include "Core/Training/Volume/Scalars.h"

#include <cmath>

namespace inr {

namespace {

/// Of `count` values; of everything where one is not finite.
template <class T>
CellRanges::Range RangeOf(const T* values, std::int64_t stride, std::int64_t count)
{
  T low = values[0];
  T high = values[0];
  bool finite = true;
  for (std::int64_t k = 0; k < count; ++k) {
    const T value = values[k * stride];
    low = value < low ? value : low;
    high = value > high ? value : high;
    finite &= std::numeric_limits<T>::is_integer || value - value == T(0);
  }
  if (!finite) {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  return {DoubleBelow(low), DoubleAbove(high)};
}

constexpr float Infinity = std::numeric_limits<float>::infinity();

ValueRange Rounded(double low, double high)
{
  ValueRange range{static_cast<float>(low), static_cast<float>(high)};
  if (static_cast<double>(range.low) > low) {
    range.low = std::nextafter(range.low, -Infinity);
  }
  if (static_cast<double>(range.high) < high) {
    range.high = std::nextafter(range.high, Infinity);
  }
  return range;
}

} // namespace

template <class T>
void CellRanges::addRows(const VolumePiece& piece, const T* values, const GridBox& box,
                         const Arena& arena)
{
  const glm::i64vec3 size = piece.data.dims;
  const glm::i64vec3 end = box.end();
  const Span columns = this->cellsOf(box.first.x, end.x, this->Cells.dims.x);
  const Span rows = this->cellsOf(box.first.y, end.y, this->Cells.dims.y);
  const Span layers = this->cellsOf(box.first.z, end.z, this->Cells.dims.z);
  const std::int64_t height = rows.end - rows.begin;
  // A task for each row of cells: no two write to the same one.
  arena.forEachBlock(height * (layers.end - layers.begin), 1, [&](std::int64_t task, std::int64_t) {
    const std::int64_t cellY = rows.begin + task % height;
    const std::int64_t cellZ = layers.begin + task / height;
    Range* cells = &this->Ranges[static_cast<std::size_t>(this->Cells.index(0, cellY, cellZ))];
    const Span ys = this->voxelsOf(cellY, box.first.y, end.y);
    const Span zs = this->voxelsOf(cellZ, box.first.z, end.z);
    for (std::int64_t z = zs.begin; z < zs.end; ++z) {
      for (std::int64_t y = ys.begin; y < ys.end; ++y) {
        const std::int64_t row = (y - piece.first.y) + size.y * (z - piece.first.z);
        for (std::int64_t x = columns.begin; x < columns.end; ++x) {
          const Span xs = this->voxelsOf(x, box.first.x, end.x);
          const T* first = values + piece.data.stride * (row * size.x + xs.begin - piece.first.x);
          cells[x].extend(RangeOf(first, piece.data.stride, xs.end - xs.begin));
        }
      }
    }
  });
}

void CellRanges::add(const VolumePiece& piece, const GridBox& box, const Arena& arena)
{
  VisitScalars(piece.data, [&](const auto* values) { this->addRows(piece, values, box, arena); });
}

void CellRanges::gather(const TrainingGroup& group)
{
  constexpr std::size_t atOnce = 1 << 16; // a MiB from each process
  for (std::size_t first = 0; first < this->Ranges.size(); first += atOnce) {
    const std::size_t count = std::min(atOnce, this->Ranges.size() - first);
    const std::string mine(reinterpret_cast<const char*>(&this->Ranges[first]),
                           count * sizeof(Range));
    for (const std::string& other : group.gather(mine)) {
      for (std::size_t k = 0; k < count; ++k) {
        this->Ranges[first + k].extend(FromBytes<Range>(other.data() + k * sizeof(Range)));
      }
    }
  }
}

MacroCells CellRanges::cells(double low, double high, double margin,
                             MacroCellProvenance provenance) const
{
  MacroCells cells = this->Cells;
  cells.provenance = provenance;
  cells.apron = static_cast<double>(MacroCellApron) / glm::dvec3(this->Dims);
  cells.ranges.reserve(this->Ranges.size());
  for (const Range& range : this->Ranges) {
    const double first = std::isfinite(range.low) ? range.low : low;
    const double last = std::isfinite(range.high) ? range.high : high;
    cells.ranges.push_back(
        Rounded((first - low) / (high - low) - margin, (last - low) / (high - low) + margin));
  }
  return cells;
}

} // namespace inr
