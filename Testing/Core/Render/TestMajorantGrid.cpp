// SPDX-License-Identifier: BSD-3-Clause
//
// What majorants and empty blocks say of cells, against looking at every value and every cell.
#include "Core/Parallel.h"
#include "Core/Random.h"
#include "Core/Render/MacroCells/MajorantGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::majorant_grid {

inr::MacroCells RandomCells(const glm::i64vec3& dims)
{
  inr::MacroCells cells;
  cells.dims = dims;
  cells.spacing = 1.0 / glm::dvec3(dims);
  for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; ++k) {
    const auto stream = static_cast<std::uint64_t>(k);
    const auto low = static_cast<float>(inr::RandomUnit(3, 2 * stream));
    const auto width = static_cast<float>(0.1 * inr::RandomUnit(3, 2 * stream + 1));
    cells.ranges.push_back({low, std::min(1.0f, low + width)});
  }
  return cells;
}

/// Mostly invisible, with random opacities among them.
inr::TransferFunction RandomFunction(std::uint64_t stream, int entries)
{
  inr::TransferFunction function;
  for (int k = 0; k < entries; ++k) {
    const auto number = static_cast<std::uint64_t>(k);
    const double opacity = inr::RandomUnit(stream, 2 * number) < 0.9
                               ? 0.0
                               : 0.999 * inr::RandomUnit(stream, 2 * number + 1);
    function.table.push_back({1, 1, 1, static_cast<float>(opacity)});
  }
  return function;
}

TEST(MajorantGrid, BoundWhatACellCanShow)
{
  const inr::MacroCells cells = RandomCells({13, 7, 11});
  inr::MajorantGrid majorants(cells);
  for (std::uint64_t stream = 0; stream < 4; ++stream) {
    const inr::ColorTable colors(RandomFunction(stream, 300), inr::VolumeInfo{});
    majorants.update(colors, inr::Arena(2));
    for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
      const inr::ValueRange& range = cells.ranges[k];
      const float majorant = majorants.extinction(static_cast<std::int64_t>(k));
      ASSERT_EQ(majorant, colors.maximumExtinction(range));
      for (int i = 0; i <= 100; ++i) {
        const float step = (range.high - range.low) / 100;
        const float value = std::min(range.low + static_cast<float>(i) * step, range.high);
        ASSERT_GE(majorant, -std::log1p(-colors.lookup().at(value).w));
      }
    }
  }
}

bool IsEmpty(const inr::MajorantGrid& majorants, const glm::i64vec3& at, int block)
{
  const glm::i64vec3 low = (at >> std::int64_t{block}) << std::int64_t{block};
  const glm::i64vec3 high = glm::min(low + (std::int64_t{1} << block), majorants.dims());
  for (std::int64_t z = low.z; z < high.z; ++z) {
    for (std::int64_t y = low.y; y < high.y; ++y) {
      for (std::int64_t x = low.x; x < high.x; ++x) {
        if (majorants.extinction(majorants.index({x, y, z})) > 0) {
          return false;
        }
      }
    }
  }
  return true;
}

void CheckBlocks(const inr::MajorantGrid& majorants)
{
  const glm::i64vec3& dims = majorants.dims();
  for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; ++k) {
    const glm::i64vec3 at = inr::GridPlace(k, dims);
    int block = -1;
    const auto largest = std::max({dims.x, dims.y, dims.z});
    while ((block < 0 || (std::int64_t{1} << block) < largest) &&
           IsEmpty(majorants, at, block + 1)) {
      ++block;
    }
    ASSERT_EQ(majorants.emptyBlock(k), block) << "cell " << k;
  }
}

TEST(MajorantGrid, KnowTheLargestEmptyBlock)
{
  for (const glm::i64vec3& dims :
       {glm::i64vec3(1), glm::i64vec3(17, 9, 12), glm::i64vec3(33, 1, 2), glm::i64vec3(8)}) {
    inr::MajorantGrid majorants(RandomCells(dims));
    for (const int entries : {2, 30, 1000}) {
      for (std::uint64_t stream = 0; stream < 3; ++stream) {
        inr::TransferFunction function = RandomFunction(stream, entries);
        majorants.update(inr::ColorTable(function, inr::VolumeInfo{}), inr::Arena(1));
        CheckBlocks(majorants);
      }
    }
  }
}

TEST(MajorantGrid, DoNotDependOnTheNumberOfThreads)
{
  const inr::MacroCells cells = RandomCells({61, 47, 53});
  const inr::ColorTable colors(RandomFunction(1, 30), inr::VolumeInfo{});
  inr::MajorantGrid one(cells);
  inr::MajorantGrid four(cells);
  one.update(colors, inr::Arena(1));
  four.update(colors, inr::Arena(4));
  for (std::int64_t k = 0; k < static_cast<std::int64_t>(cells.ranges.size()); ++k) {
    ASSERT_EQ(one.extinction(k), four.extinction(k));
    ASSERT_EQ(one.emptyBlock(k), four.emptyBlock(k));
  }
}

} // namespace test::majorant_grid
