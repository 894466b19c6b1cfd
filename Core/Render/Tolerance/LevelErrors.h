// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"
#include "Core/Inference/Evaluator.h"
#include "Core/Render/Tolerance/LineErrors.h"

#include <glm/gtc/type_precision.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <vector>

namespace inr {

/// What coarser levels of a field, and samples further apart, get wrong in each of its macro-cells:
/// a property of the field alone, of normalised values. It is measured where somebody asks, in
/// blocks of cells, and no further than they want to know.
///
/// All of it is the largest of what is found along lines of voxels of level 0 through a cell, in 13
/// directions, wherever samples may begin; see FindLongLineErrors. LevelResampling says what a
/// level is; the field is asked for nothing but voxels, and taken to be linear between those of
/// level 0.
class LevelErrors
{
public:
  static constexpr int Coarsest = 3; ///< level that is looked at

  /// Of a volume of `dims` voxels, for `cells` macro-cells, each of which is `spacing` wide in the
  /// unit cube.
  LevelErrors(const glm::i64vec3& dims, const glm::i64vec3& cells, const glm::dvec3& spacing);

  const glm::dvec3& cellEdge() const { return this->Edge; } ///< in voxels

  std::int64_t blocks() const { return GridCount(this->BlockDims); }
  std::int64_t cellsPerBlock() const;
  /// Voxels that measuring a block asks the field for, and those that it then looks at, at most.
  std::int64_t blockCost() const;
  std::int64_t blockOf(std::int64_t cell) const;

  /// Errors of samples 2, 4 and 8 times further apart, powers 1, 2 and 3, in normalised values.
  /// Only the first `known` powers are known. Of the next one there is what was found before it was
  /// too large for whoever had it measured, so that it is known to be at least that large; of the
  /// others, nothing.
  struct Powers
  {
    std::array<LineErrors, Coarsest> errors; ///< of power p at p - 1
    int known = 0;
  };
  struct Cell
  {
    Powers levels; ///< of samples of level 1, 2, 3, as far apart as its voxels
    Powers steps;  ///< of samples of level 0
  };
  const Cell& of(std::int64_t cell) const;

  /// How far somebody wants to know the errors of cells: whoever looks for the fewest samples that
  /// are good enough need not know how bad those are that are not. Of a cell that is answered by so
  /// many powers, or by all before the first that is too large, and that this one is.
  struct Question
  {
    int levels; ///< powers
    int steps;
    /// Whether errors of a cell are too large. If so, larger ones have to be, too. Called on any
    /// thread.
    std::function<bool(std::int64_t cell, const LineErrors&)> isTooLarge;
  };
  /// Whether that is answered of a cell.
  bool knows(std::int64_t cell, const Question& question) const;

  /// Measures what the question leaves open of a block's cells. Blocks may be measured on several
  /// threads at once, each of them on one. `beforeCell` may throw, to end that with nothing
  /// changed. How many points the field was asked for.
  std::int64_t measure(std::int64_t block, const Evaluator& field, const LineKernel& kernel,
                       const Question& question, const std::function<void()>& beforeCell);
  void forget(std::int64_t block) { this->Measured[static_cast<std::size_t>(block)] = {}; }
  std::int64_t measuredBlocks() const;

private:
  struct Part;
  struct Work;

  /// Of a cell in its block.
  std::size_t numberOf(const glm::i64vec3& within) const;
  std::vector<Part> partsOf(std::int64_t block) const;
  void measurePower(int power, const std::vector<Part>& parts, const Question& question,
                    Work& work) const;
  /// Voxels that samples in any of these cells may be taken for.
  void findSeen(std::initializer_list<const std::vector<Part>*> lists, int power,
                VoxelSpan (&seen)[3]) const;

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
