// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/BlockGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace test::block_grid {

struct Case
{
  glm::i64vec3 dims;
  std::int64_t mostVoxels;
};

void PrintTo(const Case& shape, std::ostream* stream)
{
  *stream << shape.dims.x << "x" << shape.dims.y << "x" << shape.dims.z;
}

class Blocks : public testing::TestWithParam<Case>
{
public:
  inr::BlockGrid Grid{GetParam().dims, GetParam().mostVoxels};
};

TEST_P(Blocks, OwnEveryVoxelOnce)
{
  const glm::i64vec3 dims = GetParam().dims;
  std::vector<int> owners(static_cast<std::size_t>(dims.x * dims.y * dims.z));
  for (std::int64_t block = 0; block < this->Grid.count(); ++block) {
    const inr::GridBox box = this->Grid.ownVoxels(block);
    for (std::int64_t k = 0; k < box.count(); ++k) {
      const glm::i64vec3 at = box.first + glm::i64vec3(k % box.size.x, k / box.size.x % box.size.y,
                                                       k / (box.size.x * box.size.y));
      ++owners.at(static_cast<std::size_t>(at.x + dims.x * (at.y + dims.y * at.z)));
    }
  }
  EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), static_cast<long>(owners.size()));
}

TEST_P(Blocks, AreSmallEnoughAndHoldWhatInterpolationNeeds)
{
  const glm::dvec3 size(GetParam().dims);
  for (std::int64_t block = 0; block < this->Grid.count(); ++block) {
    const inr::GridBox box = this->Grid.voxels(block);
    EXPECT_LE(box.count(), GetParam().mostVoxels);
    for (const float share : {0.0f, 0.3f, 0.999f}) {
      const glm::vec3 position = this->Grid.corner(block) + share * this->Grid.extent();
      EXPECT_EQ(this->Grid.blockAt(position), block);
      const glm::dvec3 at =
          glm::clamp(glm::dvec3(position) * size - 0.5, glm::dvec3(0), size - 1.0);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(static_cast<std::int64_t>(at[axis]), box.first[axis]);
        EXPECT_LT(static_cast<std::int64_t>(std::ceil(at[axis])), box.end()[axis]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Blocks,
                         testing::Values(Case{{64, 64, 64}, 20000}, Case{{37, 23, 11}, 1500},
                                         Case{{1, 301, 1}, 40}, Case{{1031, 1, 1}, 100},
                                         Case{{5, 3, 2}, 1000}, Case{{129, 65, 33}, 9000}),
                         testing::PrintToStringParamName());

TEST(BlockGrid, LeavesRoomForAMargin)
{
  const glm::i64vec3 dims(500, 400, 300);
  const inr::BlockGrid plain(dims, 1 << 20);
  const inr::BlockGrid grid(dims, 1 << 20, 3);
  double read = 0;
  for (std::int64_t block = 0; block < grid.count(); ++block) {
    const inr::GridBox box = grid.voxels(block);
    std::int64_t voxels = 1;
    for (int axis = 0; axis < 3; ++axis) {
      voxels *= std::min(box.end()[axis] + 3, dims[axis]) -
                std::max<std::int64_t>(box.first[axis] - 3, 0);
    }
    EXPECT_LE(voxels, 1 << 20);
    read += static_cast<double>(voxels);
  }
  EXPECT_GT(grid.count(), plain.count());
  EXPECT_NEAR(grid.readShare(), read / (500.0 * 400 * 300), 1e-9);
  EXPECT_GT(grid.readShare(), plain.readShare());
}

// What lies together in a file is read together, and little is read twice.
TEST(BlockGrid, KeepsRowsWhole)
{
  const inr::BlockGrid grid({10240, 7680, 1536}, std::int64_t{8} << 20);
  EXPECT_EQ(grid.extent().x, 1.0f);
  EXPECT_LT(grid.readShare(), 1.25);
  EXPECT_EQ(inr::BlockGrid({2048, 2048, 2048}, std::int64_t{16} << 20).extent().x, 1.0f);
  // Rows of a million voxels, where blocks would be thinner than is of use.
  EXPECT_LT(inr::BlockGrid({1 << 20, 64, 64}, 1 << 20).extent().x, 1.0f);
}

} // namespace test::block_grid
