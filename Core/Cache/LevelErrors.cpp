// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/LevelErrors.h"

#include "Core/Cache/LevelResampling.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace inr {

namespace {

constexpr double BlockEdge = 64; ///< voxels: a picture in a limited time waits for one block
/// Voxels on either side of a block that samples in it may be taken for.
constexpr std::int64_t Around = (1 << LevelErrors::Coarsest) / 2;
/// Voxels: along longer parts of cells, lines between the directions that are looked at are too far
/// from any of these.
constexpr std::int64_t LongestPart = 18;

glm::i64vec3 PlaceOf(std::int64_t number, const glm::i64vec3& dims)
{
  return {number % dims.x, number / dims.x % dims.y, number / (dims.x * dims.y)};
}

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

ValueBox Sampled(const VoxelSpan (&spans)[3], const glm::i64vec3& dims, const Evaluator& field)
{
  std::vector<float> axes[3];
  for (int axis = 0; axis < 3; ++axis) {
    for (std::int64_t voxel = spans[axis].low; voxel <= spans[axis].high; ++voxel) {
      axes[axis].push_back(
          static_cast<float>((static_cast<double>(voxel) + 0.5) / static_cast<double>(dims[axis])));
    }
  }
  ValueBox box({spans[0].count(), spans[1].count(), spans[2].count()});
  field.evaluateGrid(axes, box.values.data());
  for (float& value : box.values) {
    value = NormalisedOutput(value);
  }
  return box;
}

/// The largest of all parts of a part, which a line may pass one after the other.
LineErrors FindInParts(const ValueBox& fine, const ValueBox& taken, const BoxPart& whole, int power,
                       const LineKernel& kernel)
{
  const glm::i64vec3 count = (whole.size + LongestPart - std::int64_t{1}) / LongestPart;
  LineErrors errors;
  for (std::int64_t k = 0; k < count.x * count.y * count.z; ++k) {
    const glm::i64vec3 at = PlaceOf(k, count);
    const glm::i64vec3 begin = at * whole.size / count;
    const glm::i64vec3 end = (at + std::int64_t{1}) * whole.size / count;
    const LineErrors found =
        FindLineErrors(fine, taken, {whole.first + begin, end - begin}, power, kernel);
    errors.sum = std::max(errors.sum, found.sum);
    errors.magnitude = std::max(errors.magnitude, found.magnitude);
    errors.largest = std::max(errors.largest, found.largest);
  }
  const auto most = static_cast<float>(std::max(count.x, std::max(count.y, count.z)));
  return {most * errors.sum, most * errors.magnitude, errors.largest};
}

ValueBox Cut(const ValueBox& box, const BoxPart& part)
{
  ValueBox cut(part.size);
  for (std::int64_t z = 0; z < part.size.z; ++z) {
    for (std::int64_t y = 0; y < part.size.y; ++y) {
      const float* from = &box.values[box.index(part.first.x, part.first.y + y, part.first.z + z)];
      std::copy_n(from, part.size.x, &cut.values[cut.index(0, y, z)]);
    }
  }
  return cut;
}

} // namespace

struct LevelErrors::Block
{
  glm::i64vec3 begin; ///< cells
  glm::i64vec3 end;
  VoxelSpan seen[3];
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

std::int64_t LevelErrors::blockCost() const
{
  // Voxels that the coarsest level is made of, too.
  constexpr double around = 2 * (1.25 * (1 << Coarsest) + 2 + Around);
  double cost = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxels = static_cast<double>(this->CellsPerBlock[axis]) * this->Edge[axis];
    cost *= std::min(voxels + around, static_cast<double>(this->Dims[axis]));
  }
  return static_cast<std::int64_t>(cost);
}

std::int64_t LevelErrors::blockOf(std::int64_t cell) const
{
  const glm::i64vec3 at = PlaceOf(cell, this->CellDims) / this->CellsPerBlock;
  return at.x + this->BlockDims.x * (at.y + this->BlockDims.y * at.z);
}

std::size_t LevelErrors::numberOf(const glm::i64vec3& within) const
{
  return static_cast<std::size_t>(within.x + this->CellsPerBlock.x *
                                                 (within.y + this->CellsPerBlock.y * within.z));
}

const LevelErrors::Cell& LevelErrors::of(std::int64_t cell) const
{
  const glm::i64vec3 at = PlaceOf(cell, this->CellDims);
  const glm::i64vec3 block = at / this->CellsPerBlock;
  const std::int64_t number = block.x + this->BlockDims.x * (block.y + this->BlockDims.y * block.z);
  return this->Measured[static_cast<std::size_t>(number)]
                       [this->numberOf(at - block * this->CellsPerBlock)];
}

LevelErrors::Block LevelErrors::find(std::int64_t number) const
{
  Block block{};
  block.begin = PlaceOf(number, this->BlockDims) * this->CellsPerBlock;
  block.end = glm::min(block.begin + this->CellsPerBlock, this->CellDims);
  for (int axis = 0; axis < 3; ++axis) {
    block.seen[axis] =
        VoxelsOf(block.begin[axis], block.end[axis], this->Edge[axis], this->Dims[axis]);
    block.seen[axis].low = std::max<std::int64_t>(block.seen[axis].low - Around, 0);
    block.seen[axis].high = std::min(block.seen[axis].high + Around, this->Dims[axis] - 1);
  }
  return block;
}

template <typename Visit>
void LevelErrors::forEachCell(const Block& block, const Visit& visit) const
{
  const glm::i64vec3 count = block.end - block.begin;
  for (std::int64_t k = 0; k < count.x * count.y * count.z; ++k) {
    const glm::i64vec3 within = PlaceOf(k, count);
    const glm::i64vec3 at = block.begin + within;
    BoxPart part;
    for (int axis = 0; axis < 3; ++axis) {
      const VoxelSpan span = VoxelsOf(at[axis], at[axis] + 1, this->Edge[axis], this->Dims[axis]);
      part.first[axis] = span.low - block.seen[axis].low;
      part.size[axis] = span.count();
    }
    visit(this->numberOf(within), part);
  }
}

std::int64_t LevelErrors::measure(std::int64_t number, const Evaluator& field,
                                  const LineKernel& kernel)
{
  const Block block = this->find(number);
  std::vector<LevelResampling> levels;
  for (int level = 1; level <= Coarsest; ++level) {
    levels.emplace_back(block.seen, this->Dims, level);
  }
  VoxelSpan needed[3];
  glm::i64vec3 first;
  BoxPart inner;
  for (int axis = 0; axis < 3; ++axis) {
    needed[axis] = block.seen[axis];
    for (const LevelResampling& level : levels) {
      needed[axis].low = std::min(needed[axis].low, level.needed(axis).low);
      needed[axis].high = std::max(needed[axis].high, level.needed(axis).high);
    }
    first[axis] = needed[axis].low;
    inner.first[axis] = block.seen[axis].low - first[axis];
    inner.size[axis] = block.seen[axis].count();
  }
  const ValueBox around = Sampled(needed, this->Dims, field);
  const ValueBox fine = Cut(around, inner);
  const glm::i64vec3& most = this->CellsPerBlock;
  std::vector<Cell> cells(static_cast<std::size_t>(most.x * most.y * most.z));
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const ValueBox coarse = levels[level].apply(around, first);
    this->forEachCell(block, [&](std::size_t cell, const BoxPart& part) {
      const int power = static_cast<int>(level) + 1;
      cells[cell].levels[level] = FindInParts(fine, coarse, part, power, kernel);
      cells[cell].steps[level] = FindInParts(fine, fine, part, power, kernel);
    });
  }
  this->Measured[static_cast<std::size_t>(number)] = std::move(cells);
  return static_cast<std::int64_t>(around.values.size());
}

} // namespace inr
