// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/MacroCells/EmptySpace.h"

#include "Core/GridBox.h"
#include "Core/Parallel.h"

#include <algorithm>

namespace inr {

namespace {

constexpr std::int64_t CellsPerTask = 16384;

/// Calls body(y, z) for the rows of a grid.
template <typename Body>
void ForEachRow(const glm::i64vec3& dims, const Arena& arena, const Body& body)
{
  const std::int64_t rowsPerTask = std::max<std::int64_t>(1, CellsPerTask / dims.x);
  arena.forEachBlock(dims.y * dims.z, rowsPerTask, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t row = begin; row < end; ++row) {
      body(row % dims.y, row / dims.y);
    }
  });
}

} // namespace

EmptySpace::EmptySpace(const glm::i64vec3& dims)
{
  const auto add = [this](const glm::i64vec3& size) {
    this->Grids.push_back(
        {size, std::vector<std::uint8_t>(static_cast<std::size_t>(GridCount(size)))});
  };
  add(dims);
  while (this->Grids.back().nodes.size() > 1) {
    add((this->Grids.back().dims + std::int64_t{1}) / std::int64_t{2});
  }
}

void EmptySpace::update(const std::vector<float>& extinctions, const Arena& arena)
{
  std::vector<std::uint8_t>& cells = this->Grids[0].nodes;
  arena.forEachBlock(static_cast<std::int64_t>(cells.size()), CellsPerTask,
                     [&](std::int64_t begin, std::int64_t end) {
                       std::transform(extinctions.begin() + begin, extinctions.begin() + end,
                                      cells.begin() + begin, [](float extinction) -> std::uint8_t {
                                        return extinction <= 0.0f;
                                      });
                     });
  for (std::size_t level = 1; level < this->Grids.size(); ++level) {
    this->join(level, arena);
  }
  for (std::size_t level = this->Grids.size() - 1; level > 0; --level) {
    this->spread(level, arena);
  }
}

/// A node is empty if its children are.
void EmptySpace::join(std::size_t level, const Arena& arena)
{
  const Grid& fine = this->Grids[level - 1];
  Grid& coarse = this->Grids[level];
  ForEachRow(coarse.dims, arena, [&](std::int64_t y, std::int64_t z) {
    std::uint8_t* row = coarse.nodes.data() + GridNumber({0, y, z}, coarse.dims);
    std::fill_n(row, coarse.dims.x, static_cast<std::uint8_t>(level + 1));
    for (std::int64_t k = 2 * z; k < std::min(2 * z + 2, fine.dims.z); ++k) {
      for (std::int64_t j = 2 * y; j < std::min(2 * y + 2, fine.dims.y); ++j) {
        const std::uint8_t* children = fine.nodes.data() + GridNumber({0, j, k}, fine.dims);
        for (std::int64_t i = 0; i < fine.dims.x; ++i) {
          row[i / 2] = children[i] == 0 ? 0 : row[i / 2];
        }
      }
    }
  });
}

/// Children of a node in an empty block are in that block.
void EmptySpace::spread(std::size_t level, const Arena& arena)
{
  const Grid& coarse = this->Grids[level];
  Grid& fine = this->Grids[level - 1];
  ForEachRow(fine.dims, arena, [&](std::int64_t y, std::int64_t z) {
    const std::uint8_t* parents = coarse.nodes.data() + GridNumber({0, y / 2, z / 2}, coarse.dims);
    std::uint8_t* row = fine.nodes.data() + GridNumber({0, y, z}, fine.dims);
    for (std::int64_t i = 0; i < fine.dims.x; ++i) {
      row[i] = std::max(row[i], parents[i / 2]); // a full child has a full parent
    }
  });
}

} // namespace inr
