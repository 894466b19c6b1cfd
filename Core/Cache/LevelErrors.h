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
/// All of it is the largest of what is found at voxels of level 0 in a cell, so that it holds for
/// rays of any direction: errors that cancel each other along some lines do not along others.
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
  std::int64_t measure(std::int64_t block, const Evaluator& field);
  bool isMeasured(std::int64_t block) const
  {
    return this->Measured[static_cast<std::size_t>(block)] != 0;
  }

  /// Of a cell in a measured block: by how much a level differs from level 0. `level`: 1 to
  /// Coarsest.
  float difference(std::int64_t cell, int level) const
  {
    return this->of(cell).differences[static_cast<std::size_t>(level - 1)];
  }
  /// How much values change within a voxel's distance, in any direction.
  float slope(std::int64_t cell) const { return this->of(cell).slope; }
  /// And how much slopes do, in any direction: the second derivative, per voxel^2.
  float curvature(std::int64_t cell) const { return this->of(cell).curvature; }

private:
  struct Cell
  {
    std::array<float, Coarsest> differences;
    float slope = 0;
    float curvature = 0;
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
