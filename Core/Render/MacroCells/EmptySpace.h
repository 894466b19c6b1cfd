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

  /// Of every cell, 0 if it is not empty, else 1 + the k of its block. They stay where they are.
  const std::uint8_t* blocks() const { return this->Grids[0].nodes.data(); }

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
