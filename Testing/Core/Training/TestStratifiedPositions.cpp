// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Training/Samples/StratifiedPositions.h"

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace test::stratified_positions {

constexpr std::uint64_t Stream = 5;

/// Every position of batch number `batch`.
std::vector<glm::vec3> Batch(const inr::StratifiedPositions& boxes, std::uint64_t batch)
{
  std::vector<glm::vec3> positions;
  for (std::int64_t k = 0; k < boxes.count(); ++k) {
    positions.push_back(boxes.at(k, Stream, batch * boxes.count() + k));
  }
  return positions;
}

bool InVoxelCentre(const glm::vec3& position, const glm::i64vec3& dims)
{
  bool centre = true;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxel =
        static_cast<double>(position[axis]) * static_cast<double>(dims[axis]) - 0.5;
    centre = centre && std::abs(voxel - std::round(voxel)) < 1e-4;
  }
  return centre;
}

TEST(StratifiedPositions, EveryBatchCoversTheVolumeEvenly)
{
  // 4096 boxes of a volume twice as long as wide: 32 x 16 x 8. Halves of free positions only, as
  // the centre of a voxel may lie in the box beside.
  const glm::i64vec3 dims(400, 200, 100);
  const inr::StratifiedPositions boxes(dims, 4096);
  for (const std::uint64_t batch : {0, 1}) {
    const std::vector<glm::vec3> positions = Batch(boxes, batch);
    std::set<std::array<int, 3>> seen;
    for (std::size_t k = batch % 2; k < positions.size(); k += 2) {
      const glm::ivec3 box(positions[k] * glm::vec3(32, 16, 8));
      seen.insert({box.x, box.y, box.z});
    }
    EXPECT_EQ(seen.size(), 2048u);
  }
}

TEST(StratifiedPositions, HalfOfThemAreVoxelsAndEveryBoxHasBothKinds)
{
  const glm::i64vec3 dims(91, 60, 33);
  const inr::StratifiedPositions boxes(dims, 1024);
  const std::vector<glm::vec3> first = Batch(boxes, 6);
  const std::vector<glm::vec3> second = Batch(boxes, 7);
  for (std::size_t k = 0; k < first.size(); ++k) {
    EXPECT_NE(InVoxelCentre(first[k], dims), InVoxelCentre(second[k], dims)) << k;
  }
}

TEST(StratifiedPositions, AreUniform)
{
  const glm::i64vec3 dims(7, 5, 3);
  const inr::StratifiedPositions boxes(dims, 64);
  std::vector<int> hits(7 * 5 * 3);
  constexpr int batches = 3000;
  for (std::uint64_t batch = 0; batch < batches; ++batch) {
    for (const glm::vec3& position : Batch(boxes, batch)) {
      const glm::ivec3 voxel =
          glm::min(glm::ivec3(position * glm::vec3(dims)), glm::ivec3(6, 4, 2));
      ++hits[static_cast<std::size_t>(voxel.x + 7 * (voxel.y + 5 * voxel.z))];
    }
  }
  const double expected = 64.0 * batches / static_cast<double>(hits.size());
  for (const int count : hits) {
    EXPECT_NEAR(count, expected, 6 * std::sqrt(expected));
  }
}

TEST(StratifiedPositions, StayInTheMiddleOfAnAxisOfOneVoxel)
{
  const inr::StratifiedPositions slab({64, 1, 64}, 256);
  for (const glm::vec3& position : Batch(slab, 0)) {
    EXPECT_EQ(position.y, 0.5f);
  }
  const inr::StratifiedPositions voxel({1, 1, 1}, 256);
  for (const glm::vec3& position : Batch(voxel, 0)) {
    EXPECT_EQ(position, glm::vec3(0.5f));
  }
}

} // namespace test::stratified_positions
