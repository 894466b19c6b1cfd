// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Inference/Evaluator.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace inr {

struct ValueBox;

/// What the coarser levels of a field get wrong in each of its macro-cells: a property of the field
/// alone, of normalised values. It is measured where somebody asks, in blocks of cells.
///
/// Levels are compared with level 0 at its voxels, along the lines of voxels through a cell in all
/// three directions: what a ray adds up there is off by the mean of the differences, which is often
/// much less than the differences are. LevelResampling says what a level is; it asks the field for
/// nothing but voxels of level 0.
class LevelErrors
{
public:
  static constexpr int Coarsest = 3; ///< level that is looked at

  /// Of one level in one cell.
  struct Error
  {
    float mean = 0;   ///< |mean difference| along a line, the largest of all lines
    float spread = 0; ///< mean |difference| along a line, the largest of all lines
  };

  /// Of a volume of `dims` voxels, for `cells` macro-cells, each of which is `spacing` wide in the
  /// unit cube.
  LevelErrors(const glm::i64vec3& dims, const glm::i64vec3& cells, const glm::dvec3& spacing);

  const glm::dvec3& cellEdge() const { return this->Edge; } ///< in voxels

  std::int64_t blocks() const { return this->BlockDims.x * this->BlockDims.y * this->BlockDims.z; }
  /// Voxels that measuring a block asks the field for, at most.
  std::int64_t blockCost() const;
  std::int64_t blockOf(std::int64_t cell) const;

  /// Blocks may be measured on several threads at once, each of them on one. How many points the
  /// field was asked for.
  std::int64_t measure(std::int64_t block, const Evaluator& field);
  bool isMeasured(std::int64_t block) const
  {
    return this->Measured[static_cast<std::size_t>(block)] != 0;
  }

  /// Of a cell in a measured block. `level`: 1 to Coarsest.
  const Error& error(std::int64_t cell, int level) const
  {
    return this->Cells[static_cast<std::size_t>(cell)].levels[static_cast<std::size_t>(level - 1)];
  }
  /// The same: how much values change from voxel to voxel along a line, in the mean; the largest of
  /// all lines.
  float slope(std::int64_t cell) const { return this->Cells[static_cast<std::size_t>(cell)].slope; }

private:
  struct Cell
  {
    std::array<Error, Coarsest> levels;
    float slope = 0;
  };
  struct Block;
  Block find(std::int64_t block) const;
  template <typename Visit> void forEachCell(const Block& block, const Visit& visit);

  glm::i64vec3 Dims; ///< voxels
  glm::i64vec3 CellDims;
  glm::dvec3 Edge;               ///< of a cell, in voxels
  glm::i64vec3 CellsPerBlock{1}; ///< along each axis
  glm::i64vec3 BlockDims{1};
  std::vector<Cell> Cells; ///< x fastest
  std::vector<char> Measured;
};

} // namespace inr
