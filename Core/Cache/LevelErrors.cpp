// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/LevelErrors.h"

#include "Core/Cache/LevelResampling.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

constexpr double BlockEdge = 128; ///< voxels: what lies around them is then less than they are

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

/// Part of a box.
struct Part
{
  glm::i64vec3 first{0};
  glm::i64vec3 size{0};
};

ValueBox Cut(const ValueBox& box, const Part& part)
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

/// Sums along all lines of an axis through a part of a box.
struct LineSums
{
  std::vector<float> signedSums;
  std::vector<float> absoluteSums;
};

LineSums SumsAlong(int axis, const ValueBox& box, const Part& part)
{
  const int across = axis == 0 ? 1 : 0;
  const int rest = 3 - axis - across;
  const std::int64_t width = part.size[across];
  const auto lines = static_cast<std::size_t>(width * part.size[rest]);
  LineSums sums{std::vector<float>(lines), std::vector<float>(lines)};
  const float* origin = &box.values[box.index(part.first.x, part.first.y, part.first.z)];
  const std::int64_t stride = box.stride(across);
  for (std::int64_t line = 0; line < part.size[rest]; ++line) {
    float* signedSum = &sums.signedSums[static_cast<std::size_t>(line * width)];
    float* absoluteSum = &sums.absoluteSums[static_cast<std::size_t>(line * width)];
    for (std::int64_t k = 0; k < part.size[axis]; ++k) {
      const float* row = origin + k * box.stride(axis) + line * box.stride(rest);
      for (std::int64_t i = 0; i < width; ++i) {
        signedSum[i] += row[i * stride];
        absoluteSum[i] += std::abs(row[i * stride]);
      }
    }
  }
  return sums;
}

LevelErrors::Error ErrorOf(const ValueBox& differences, const Part& part)
{
  LevelErrors::Error error;
  for (int axis = 0; axis < 3; ++axis) {
    const LineSums sums = SumsAlong(axis, differences, part);
    const auto length = static_cast<float>(part.size[axis]);
    for (std::size_t line = 0; line < sums.signedSums.size(); ++line) {
      error.mean = std::max(error.mean, std::abs(sums.signedSums[line]) / length);
      error.spread = std::max(error.spread, sums.absoluteSums[line] / length);
    }
  }
  return error;
}

/// From each voxel to the next along an axis; 0 at the last.
ValueBox Changes(const ValueBox& box, int axis)
{
  ValueBox changes(box.size);
  const auto stride = static_cast<std::size_t>(box.stride(axis));
  for (std::size_t k = 0; k + stride < box.values.size(); ++k) {
    changes.values[k] = box.values[k + stride] - box.values[k];
  }
  return changes;
}

float SlopeOf(const ValueBox& changes, int axis, Part part)
{
  if (--part.size[axis] == 0) {
    return 0.0f;
  }
  const LineSums sums = SumsAlong(axis, changes, part);
  return *std::max_element(sums.absoluteSums.begin(), sums.absoluteSums.end()) /
         static_cast<float>(part.size[axis]);
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
    : Dims(dims), CellDims(cells), Edge(spacing * glm::dvec3(dims)),
      Cells(static_cast<std::size_t>(cells.x * cells.y * cells.z))
{
  for (int axis = 0; axis < 3; ++axis) {
    const auto fit = static_cast<std::int64_t>(BlockEdge / this->Edge[axis]);
    this->CellsPerBlock[axis] = std::clamp<std::int64_t>(fit, 1, this->CellDims[axis]);
    this->BlockDims[axis] =
        (this->CellDims[axis] + this->CellsPerBlock[axis] - 1) / this->CellsPerBlock[axis];
  }
  this->Measured.resize(static_cast<std::size_t>(this->blocks()), 0);
}

std::int64_t LevelErrors::blockCost() const
{
  constexpr double around = 2 * (1.25 * (1 << Coarsest) + 2); // voxels that the coarsest is made of
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

LevelErrors::Block LevelErrors::find(std::int64_t number) const
{
  Block block{};
  block.begin = PlaceOf(number, this->BlockDims) * this->CellsPerBlock;
  block.end = glm::min(block.begin + this->CellsPerBlock, this->CellDims);
  for (int axis = 0; axis < 3; ++axis) {
    block.seen[axis] =
        VoxelsOf(block.begin[axis], block.end[axis], this->Edge[axis], this->Dims[axis]);
  }
  return block;
}

template <typename Visit> void LevelErrors::forEachCell(const Block& block, const Visit& visit)
{
  const glm::i64vec3 count = block.end - block.begin;
  for (std::int64_t k = 0; k < count.x * count.y * count.z; ++k) {
    const glm::i64vec3 at = block.begin + PlaceOf(k, count);
    Part part;
    for (int axis = 0; axis < 3; ++axis) {
      const VoxelSpan span = VoxelsOf(at[axis], at[axis] + 1, this->Edge[axis], this->Dims[axis]);
      part.first[axis] = span.low - block.seen[axis].low;
      part.size[axis] = span.count();
    }
    const std::int64_t cell = at.x + this->CellDims.x * (at.y + this->CellDims.y * at.z);
    visit(this->Cells[static_cast<std::size_t>(cell)], part);
  }
}

std::int64_t LevelErrors::measure(std::int64_t number, const Evaluator& field)
{
  const Block block = this->find(number);
  std::vector<LevelResampling> levels;
  for (int level = 1; level <= Coarsest; ++level) {
    levels.emplace_back(block.seen, this->Dims, level);
  }
  VoxelSpan needed[3];
  glm::i64vec3 first;
  Part inner;
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
  for (int axis = 0; axis < 3; ++axis) {
    const ValueBox changes = Changes(fine, axis);
    this->forEachCell(block, [&](Cell& cell, const Part& part) {
      cell.slope = std::max(cell.slope, SlopeOf(changes, axis, part));
    });
  }
  for (std::size_t level = 0; level < levels.size(); ++level) {
    ValueBox differences = levels[level].apply(around, first);
    for (std::size_t k = 0; k < differences.values.size(); ++k) {
      differences.values[k] -= fine.values[k];
    }
    this->forEachCell(block, [&](Cell& cell, const Part& part) {
      cell.levels[level] = ErrorOf(differences, part);
    });
  }
  this->Measured[static_cast<std::size_t>(number)] = 1;
  return static_cast<std::int64_t>(around.values.size());
}

} // namespace inr
