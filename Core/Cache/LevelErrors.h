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
/// directions, wherever samples may begin; through a cell of more than 16 voxels, part by part.
/// LevelResampling says what a level is; the field is asked for nothing but voxels of level 0, and
/// taken to be linear in between.
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
  std::int64_t measure(std::int64_t block, const Evaluator& field, const LineKernel& kernel);
  bool isMeasured(std::int64_t block) const
  {
    return !this->Measured[static_cast<std::size_t>(block)].empty();
  }

  /// In normalised values.
  struct Cell
  {
    std::array<LineErrors, Coarsest>
        levels;                             ///< of samples of level l = 1, 2, ..., 2^l voxels apart
    std::array<LineErrors, Coarsest> steps; ///< of level 0, 2, 4, ... voxels apart
  };
  /// Of one in a measured block.
  const Cell& of(std::int64_t cell) const;

private:
  /// Of a cell in its block.
  std::size_t numberOf(const glm::i64vec3& within) const;
  struct Block;
  Block find(std::int64_t block) const;
  /// Calls `visit` with the number of a cell in its block and with its voxels.
  template <typename Visit> void forEachCell(const Block& block, const Visit& visit) const;

  glm::i64vec3 Dims; ///< voxels
  glm::i64vec3 CellDims;
  glm::dvec3 Edge;               ///< of a cell, in voxels
  glm::i64vec3 CellsPerBlock{1}; ///< along each axis
  glm::i64vec3 BlockDims{1};
  /// Of each block, x fastest, as if it were a whole one; none before it is measured, as a volume
  /// may have more cells than there is memory for.
  std::vector<std::vector<Cell>> Measured;
};

} // namespace inr
