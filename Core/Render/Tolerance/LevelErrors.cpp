// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LevelErrors.h"

#include "Core/Cache/LevelPoints.h"
#include "Core/GridBox.h"
#include "Core/Render/Tolerance/FieldWindow.h"
#include "Core/Render/Tolerance/LevelResampling.h"
#include "Core/Render/Tolerance/LongLines.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace inr {

namespace {

static_assert(LevelErrors::Coarsest <= 3, "LineKernel compares samples with up to 9 values");

/// Voxels. Smaller blocks would ask for much that their neighbours ask for, too: up to 16 voxels
/// around them, so that of 64 it is 3.4 times the voxels at worst. A picture in a limited time
/// waits for one block.
constexpr double BlockEdge = 64;

/// What can be seen of voxels in cells `begin` to `end` - 1: those inside and one more on either
/// side, as rays go between voxels.
VoxelSpan VoxelsOf(std::int64_t begin, std::int64_t end, double edge, std::int64_t size)
{
  const double low = std::floor(static_cast<double>(begin) * edge - 0.5);
  const double high = std::ceil(static_cast<double>(end) * edge - 0.5);
  const auto last = static_cast<double>(size - 1);
  return {static_cast<std::int64_t>(std::clamp(low, 0.0, last)),
          static_cast<std::int64_t>(std::clamp(high, 0.0, last))};
}

/// Whether so many powers are known, or that the first one that is not is too large.
bool Answer(const LevelErrors::Powers& powers, int wanted, std::int64_t cell,
            const LevelErrors::Question& question)
{
  return powers.known >= wanted ||
         question.isTooLarge(cell, powers.errors[static_cast<std::size_t>(powers.known)]);
}

} // namespace

/// A cell of a block.
struct LevelErrors::Part
{
  std::int64_t cell;
  std::size_t number; ///< in the block
  VoxelSpan seen[3];
};

struct LevelErrors::Work
{
  const Evaluator& source;
  FieldWindow field;             ///< level 0
  std::int64_t coarsePoints = 0; ///< that `source` was asked for besides
  const LineKernel& kernel;
  const std::function<void()>& beforeCell;
  std::vector<Cell> cells;

  /// What a level has at the voxels `seen` of level 0.
  ValueBox levelAt(const VoxelSpan (&seen)[3], const glm::i64vec3& dims, int level)
  {
    const int points = PointsPerAxis(dims, level, this->source.resolution());
    const LevelResampling resampling(seen, dims, level, points);
    const VoxelSpan needed[3] = {resampling.needed(0), resampling.needed(1), resampling.needed(2)};
    if (points > 1) {
      this->field.extendTo(needed);
      return resampling.apply(this->field.cut(needed), LowOf(needed));
    }
    FieldWindow voxels(this->source, VoxelsAtLevel(dims, level));
    voxels.extendTo(needed);
    this->coarsePoints += voxels.points();
    return resampling.apply(voxels.cut(needed), LowOf(needed));
  }

  /// Errors of samples of `taken`, which has the voxels `seen`.
  void find(const std::vector<Part>& parts, Powers Cell::*which, int power, const ValueBox& taken,
            const VoxelSpan (&seen)[3], const Question& question)
  {
    const ValueBox fine = this->field.cut(seen);
    for (const Part& part : parts) {
      this->beforeCell();
      const auto isTooLarge = [&](const LineErrors& errors) {
        return question.isTooLarge(part.cell, errors);
      };
      const LineErrors errors =
          FindLongLineErrors(fine, taken, {LowOf(part.seen) - LowOf(seen), SizeOf(part.seen)},
                             power, this->kernel, isTooLarge);
      Powers& powers = this->cells[part.number].*which;
      powers.errors[static_cast<std::size_t>(power) - 1] = errors;
      powers.known = isTooLarge(errors) ? power - 1 : power;
    }
  }
};

LevelErrors::LevelErrors(const glm::i64vec3& dims, const glm::i64vec3& cells,
                         const glm::dvec3& spacing)
    : Dims(dims), CellDims(cells), Edge(spacing * glm::dvec3(dims))
{
  for (int axis = 0; axis < 3; ++axis) {
    const auto fit = static_cast<std::int64_t>(BlockEdge / this->Edge[axis]);
    this->CellsPerBlock[axis] = std::clamp<std::int64_t>(fit, 1, this->CellDims[axis]);
    this->BlockDims[axis] =
        (this->CellDims[axis] + this->CellsPerBlock[axis] - 1) / this->CellsPerBlock[axis];
  }
  this->Measured.resize(static_cast<std::size_t>(this->blocks()));
}

std::int64_t LevelErrors::cellsPerBlock() const { return GridCount(this->CellsPerBlock); }

std::int64_t LevelErrors::blockCost() const
{
  // Voxels that the coarsest level is made of, too.
  constexpr double around = 2 * (1.75 * (1 << Coarsest) + 2);
  double asked = 1;
  double seen = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cells = static_cast<double>(this->CellsPerBlock[axis]);
    const auto size = static_cast<double>(this->Dims[axis]);
    asked *= std::min(cells * this->Edge[axis] + around, size);
    seen *= cells * std::min(this->Edge[axis] + 2, size);
  }
  return static_cast<std::int64_t>(asked + seen);
}

std::int64_t LevelErrors::blockOf(std::int64_t cell) const
{
  return GridNumber(GridPlace(cell, this->CellDims) / this->CellsPerBlock, this->BlockDims);
}

std::size_t LevelErrors::numberOf(const glm::i64vec3& within) const
{
  return static_cast<std::size_t>(GridNumber(within, this->CellsPerBlock));
}

const LevelErrors::Cell& LevelErrors::of(std::int64_t cell) const
{
  static const Cell unknown;
  const std::vector<Cell>& cells = this->Measured[static_cast<std::size_t>(this->blockOf(cell))];
  return cells.empty()
             ? unknown
             : cells[this->numberOf(GridPlace(cell, this->CellDims) % this->CellsPerBlock)];
}

bool LevelErrors::knows(std::int64_t cell, const Question& question) const
{
  const Cell& known = this->of(cell);
  return Answer(known.levels, question.levels, cell, question) &&
         Answer(known.steps, question.steps, cell, question);
}

std::int64_t LevelErrors::measuredBlocks() const
{
  return std::count_if(this->Measured.begin(), this->Measured.end(),
                       [](const std::vector<Cell>& cells) { return !cells.empty(); });
}

std::vector<LevelErrors::Part> LevelErrors::partsOf(std::int64_t block) const
{
  const glm::i64vec3 begin = GridPlace(block, this->BlockDims) * this->CellsPerBlock;
  const glm::i64vec3 count = glm::min(this->CellsPerBlock, this->CellDims - begin);
  std::vector<Part> parts;
  for (std::int64_t k = 0; k < GridCount(count); ++k) {
    const glm::i64vec3 within = GridPlace(k, count);
    const glm::i64vec3 at = begin + within;
    Part part{};
    part.cell = GridNumber(at, this->CellDims);
    part.number = this->numberOf(within);
    for (int axis = 0; axis < 3; ++axis) {
      part.seen[axis] = VoxelsOf(at[axis], at[axis] + 1, this->Edge[axis], this->Dims[axis]);
    }
    parts.push_back(part);
  }
  return parts;
}

std::int64_t LevelErrors::measure(std::int64_t block, const Evaluator& field,
                                  const LineKernel& kernel, const Question& question,
                                  const std::function<void()>& beforeCell)
{
  std::vector<Cell>& measured = this->Measured[static_cast<std::size_t>(block)];
  Work work{field, {field, this->Dims}, 0, kernel, beforeCell, measured};
  work.cells.resize(static_cast<std::size_t>(this->cellsPerBlock()));
  const std::vector<Part> parts = this->partsOf(block);
  for (int power = 1; power <= std::max(question.levels, question.steps); ++power) {
    this->measurePower(power, parts, question, work);
  }
  measured = std::move(work.cells);
  return work.field.points() + work.coarsePoints;
}

void LevelErrors::measurePower(int power, const std::vector<Part>& parts, const Question& question,
                               Work& work) const
{
  // Whose power is the next to be known.
  const auto open = [&](Powers Cell::*which, int wanted) {
    std::vector<Part> cells;
    std::copy_if(parts.begin(), parts.end(), std::back_inserter(cells), [&](const Part& part) {
      const Powers& powers = work.cells[part.number].*which;
      return powers.known == power - 1 && !Answer(powers, wanted, part.cell, question);
    });
    return cells;
  };
  const std::vector<Part> levels = open(&Cell::levels, question.levels);
  const std::vector<Part> steps = open(&Cell::steps, question.steps);
  if (levels.empty() && steps.empty()) {
    return;
  }
  VoxelSpan seen[3];
  this->findSeen({&levels, &steps}, power, seen);
  work.field.extendTo(seen);
  if (!levels.empty()) {
    work.find(levels, &Cell::levels, power, work.levelAt(seen, this->Dims, power), seen, question);
  }
  work.find(steps, &Cell::steps, power, work.field.cut(seen), seen, question);
}

void LevelErrors::findSeen(std::initializer_list<const std::vector<Part>*> lists, int power,
                           VoxelSpan (&seen)[3]) const
{
  const std::int64_t reach = (std::int64_t{1} << power) / 2; // of a sample
  for (int axis = 0; axis < 3; ++axis) {
    seen[axis] = {this->Dims[axis] - 1, 0};
    for (const std::vector<Part>* parts : lists) {
      for (const Part& part : *parts) {
        seen[axis].low = std::min(seen[axis].low, part.seen[axis].low);
        seen[axis].high = std::max(seen[axis].high, part.seen[axis].high);
      }
    }
    seen[axis].low = std::max<std::int64_t>(seen[axis].low - reach, 0);
    seen[axis].high = std::min(seen[axis].high + reach, this->Dims[axis] - 1);
  }
}

} // namespace inr
