// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/LineErrors.h"
#include "Core/Inference/Evaluator.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace inr {

/// What coarser levels of a field, and samples further apart, get wrong in each of its macro-cells:
/// a property of the field alone, of normalised values. It is measured where somebody asks, in
/// blocks of cells.
///
/// All of it is the largest of what is found along lines of voxels of level 0 through a cell, in 13
/// directions, so that it is that of rays of nearly any. LevelResampling says what a level is; the
/// field is asked for nothing but voxels of level 0, and taken to be linear in between.
class LevelErrors
{
public:
  static constexpr int Coarsest = 3; ///< level that is looked at

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

  /// Of a cell in a measured block, in normalised values: of samples of a level, 2^level voxels
  /// apart. `level`: 1 to Coarsest.
  const LineErrors& ofLevel(std::int64_t cell, int level) const
  {
    return this->of(cell).levels[static_cast<std::size_t>(level - 1)];
  }
  /// The same of samples of level 0, 2^power voxels apart. `power`: 1 to Coarsest.
  const LineErrors& ofSteps(std::int64_t cell, int power) const
  {
    return this->of(cell).steps[static_cast<std::size_t>(power - 1)];
  }

private:
  struct Cell
  {
    std::array<LineErrors, Coarsest> levels;
    std::array<LineErrors, Coarsest> steps;
  };
  const Cell& of(std::int64_t cell) const { return this->Cells[static_cast<std::size_t>(cell)]; }
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
