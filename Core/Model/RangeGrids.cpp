// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/RangeGrids.h"

#include "Core/GridBox.h"
#include "Core/Parallel.h"

#include <algorithm>

namespace inr {

namespace {

/// Calls body(row, y, z) for the rows of a grid's ranges.
template <typename Body> void ForEachRow(MacroCells& cells, const Arena& arena, const Body& body)
{
  constexpr std::int64_t cellsPerTask = 16384;
  const glm::i64vec3& dims = cells.dims;
  const std::int64_t rowsPerTask = std::max<std::int64_t>(1, cellsPerTask / dims.x);
  arena.forEachBlock(dims.y * dims.z, rowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t row = begin; row < end; ++row) {
      body(cells.ranges.data() + row * dims.x, row % dims.y, row / dims.y);
    }
  });
}

MacroCells LikeWith(const MacroCells& cells, const glm::i64vec3& dims, const glm::dvec3& spacing)
{
  MacroCells like;
  like.dims = dims;
  like.spacing = spacing;
  like.apron = cells.apron;
  like.provenance = cells.provenance;
  like.ranges.resize(static_cast<std::size_t>(GridCount(dims)));
  return like;
}

const ValueRange* Row(const MacroCells& cells, std::int64_t y, std::int64_t z)
{
  return cells.ranges.data() + cells.index(0, y, z);
}

/// The ranges of `count` cells of a row, of those at -`stride` and of those at `stride`, where
/// there are such.
void DilateRow(const ValueRange* from, std::int64_t count, std::int64_t stride, bool before,
               bool after, ValueRange* to)
{
  std::copy_n(from, count, to);
  for (std::int64_t k = 0; before && k < count; ++k) {
    to[k].extend(from[k - stride]);
  }
  for (std::int64_t k = 0; after && k < count; ++k) {
    to[k].extend(from[k + stride]);
  }
}

} // namespace

MacroCells Joined(const MacroCells& cells, const Arena& arena)
{
  const glm::i64vec3 dims = (cells.dims + std::int64_t{1}) / std::int64_t{2};
  MacroCells joined = LikeWith(cells, dims, 2.0 * cells.spacing);
  ForEachRow(joined, arena, [&](ValueRange* row, std::int64_t y, std::int64_t z) {
    for (std::int64_t k = 2 * z; k < std::min(2 * z + 2, cells.dims.z); ++k) {
      for (std::int64_t j = 2 * y; j < std::min(2 * y + 2, cells.dims.y); ++j) {
        const ValueRange* from = Row(cells, j, k);
        for (std::int64_t x = 0; x < cells.dims.x; ++x) {
          row[x / 2].extend(from[x]);
        }
      }
    }
  });
  return joined;
}

MacroCells Dilated(const MacroCells& cells, const Arena& arena)
{
  const glm::i64vec3& dims = cells.dims;
  MacroCells first = LikeWith(cells, dims, cells.spacing);
  MacroCells second = first;
  ForEachRow(first, arena, [&](ValueRange* row, std::int64_t y, std::int64_t z) {
    const ValueRange* from = Row(cells, y, z);
    std::copy_n(from, dims.x, row);
    for (std::int64_t x = 1; x < dims.x; ++x) {
      row[x].extend(from[x - 1]);
      row[x - 1].extend(from[x]);
    }
  });
  ForEachRow(second, arena, [&](ValueRange* row, std::int64_t y, std::int64_t z) {
    DilateRow(Row(first, y, z), dims.x, dims.x, y > 0, y + 1 < dims.y, row);
  });
  ForEachRow(first, arena, [&](ValueRange* row, std::int64_t y, std::int64_t z) {
    DilateRow(Row(second, y, z), dims.x, dims.x * dims.y, z > 0, z + 1 < dims.z, row);
  });
  return first;
}

} // namespace inr
