// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/gtc/type_precision.hpp>

#include <cstdint>
#include <vector>

namespace inr {

class Arena;

/// For every cell of a grid, the largest block of empty cells that it lies in. Blocks are cubes of
/// 2^k cells per axis at multiples of their size; they may overhang the grid, as nothing is there.
class EmptySpace
{
public:
  /// Cells per axis, at least 1; all are taken for full.
  explicit EmptySpace(const glm::i64vec3& dims);

  /// Takes cells with an extinction of 0 for empty; they are numbered x fastest.
  void update(const std::vector<float>& extinctions, const Arena& arena);

  /// k of a cell's block, -1 if the cell is not empty.
  int block(std::int64_t cell) const
  {
    return static_cast<int>(this->Grids[0].nodes[static_cast<std::size_t>(cell)]) - 1;
  }

private:
  /// Nodes of 2^k cells per axis: 0 = full, else 1 + the k of the largest empty block around.
  struct Grid
  {
    glm::i64vec3 dims;
    std::vector<std::uint8_t> nodes;
  };

  void join(std::size_t level, const Arena& arena);
  void spread(std::size_t level, const Arena& arena);

  std::vector<Grid> Grids; ///< from cells to a single node
};

} // namespace inr
