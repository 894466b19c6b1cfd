// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/LevelErrors.h"

#include "Core/Cache/LevelResampling.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

constexpr double BlockEdge = 64; ///< voxels: a picture in a limited time waits for one block

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

/// Calls `visit` with the index of the first value of each row along x of a part.
template <typename Visit> void ForEachRow(const ValueBox& box, const Part& part, const Visit& visit)
{
  for (std::int64_t z = 0; z < part.size.z; ++z) {
    for (std::int64_t y = 0; y < part.size.y; ++y) {
      visit(box.index(part.first.x, part.first.y + y, part.first.z + z));
    }
  }
}

float LargestOf(const ValueBox& box, const Part& part)
{
  float largest = 0;
  ForEachRow(box, part, [&](std::size_t row) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(part.size.x); ++x) {
      largest = std::max(largest, std::abs(box.values[row + x]));
    }
  });
  return largest;
}

std::int64_t OffsetOf(const ValueBox& box, const glm::i64vec3& way)
{
  return way.x * box.stride(0) + way.y * box.stride(1) + way.z * box.stride(2);
}

/// Of a gradient whose parts along the axes are the largest that there are.
float SlopeOf(const ValueBox& box, const Part& part)
{
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    Part inner = part;
    --inner.size[axis];
    const auto next = static_cast<std::size_t>(box.stride(axis));
    float largest = 0;
    ForEachRow(box, inner, [&](std::size_t row) {
      for (std::size_t k = row; k < row + static_cast<std::size_t>(inner.size.x); ++k) {
        largest = std::max(largest, std::abs(box.values[k + next] - box.values[k]));
      }
    });
    sum += largest * largest;
  }
  return std::sqrt(sum);
}

/// Along the edges and the diagonals of faces and of the volume of a cube.
constexpr int Ways[13][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                             {1, 0, 1},  {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {1, 1, 1},
                             {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};

float CurvatureOf(const ValueBox& box, const Part& part)
{
  float largest = 0;
  for (const auto& to : Ways) {
    const glm::i64vec3 way(to[0], to[1], to[2]);
    const glm::i64vec3 width = glm::abs(way);
    const Part inner{part.first + width, part.size - std::int64_t{2} * width};
    if (glm::min(inner.size.x, glm::min(inner.size.y, inner.size.z)) <= 0) {
      continue; // flat that way
    }
    const std::int64_t offset = OffsetOf(box, way);
    const float perLength = 1.0f / static_cast<float>(width.x + width.y + width.z);
    ForEachRow(box, inner, [&](std::size_t row) {
      const float* at = &box.values[row];
      for (std::int64_t x = 0; x < inner.size.x; ++x, ++at) {
        largest = std::max(largest, perLength * std::abs(at[offset] + at[-offset] - 2 * *at));
      }
    });
  }
  return largest;
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
  this->forEachCell(block, [&](Cell& cell, const Part& part) {
    cell.slope = SlopeOf(fine, part);
    cell.curvature = CurvatureOf(fine, part);
  });
  for (std::size_t level = 0; level < levels.size(); ++level) {
    ValueBox differences = levels[level].apply(around, first);
    for (std::size_t k = 0; k < differences.values.size(); ++k) {
      differences.values[k] -= fine.values[k];
    }
    this->forEachCell(block, [&](Cell& cell, const Part& part) {
      cell.differences[level] = LargestOf(differences, part);
    });
  }
  this->Measured[static_cast<std::size_t>(number)] = 1;
  return static_cast<std::int64_t>(around.values.size());
}

} // namespace inr
