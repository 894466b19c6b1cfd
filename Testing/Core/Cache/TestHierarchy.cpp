// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/Hierarchy.h"
#include "Core/Error.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace test::hierarchy {

using glm::dvec3;
using glm::i64vec3;

const i64vec3 Sizes[] = {{1, 1, 1},
                         {2, 3, 5},
                         {7, 8, 9},
                         {39, 40, 41},
                         {1, 79, 80},
                         {10240, 7680, 1536},
                         {131072, 131072, 131072}};

dvec3 RandomPoint(const i64vec3& dims, std::uint64_t k)
{
  const auto random = [k](std::uint64_t axis) {
    return static_cast<double>(inr::RandomUnit(7, 3 * k + axis)) +
           1e-8 * inr::RandomUnit(8, 3 * k + axis);
  };
  return dvec3(random(0), random(1), random(2)) * dvec3(dims - std::int64_t{1});
}

TEST(Hierarchy, HalvesRoundingUpUntilOneBrickIsEnough)
{
  const inr::Hierarchy levels({131072, 7680, 1}, 40);
  for (int level = 0; level + 1 < levels.levels(); ++level) {
    EXPECT_NE(levels.bricks(level), i64vec3(1));
    for (int axis = 0; axis < 3; ++axis) {
      const auto half =
          static_cast<std::int64_t>(std::ceil(static_cast<double>(levels.size(level)[axis]) / 2));
      EXPECT_EQ(levels.size(level + 1)[axis], half);
    }
  }
  EXPECT_EQ(levels.bricks(levels.levels() - 1), i64vec3(1));
  EXPECT_EQ(levels.levels(), 13); // 131072 / 2^12 = 32 voxels
}

// Or pictures from afar would depend on the size of bricks.
TEST(Hierarchy, HasTheSameLevelsForAllLargeBricks)
{
  for (const i64vec3& dims : Sizes) {
    const inr::Hierarchy usual(dims, 40);
    for (const int size : {41, 64, 300, 1024}) {
      const inr::Hierarchy large(dims, size);
      EXPECT_EQ(large.levels(), usual.levels()) << size;
      EXPECT_EQ(large.size(large.levels() - 1), usual.size(usual.levels() - 1)) << size;
    }
  }
}

TEST(Hierarchy, KeysAndPlacesAreOneToOne)
{
  const inr::BrickId ids[] = {{0, {0, 0, 0}}, {12, {3360, 1, 2}}, {31, {524287, 524287, 524287}}};
  for (const inr::BrickId& id : ids) {
    const inr::BrickId again = inr::IdOf(inr::KeyOf(id));
    EXPECT_EQ(again.level, id.level);
    EXPECT_EQ(again.at, id.at);
  }
}

TEST(Hierarchy, TheCoarserBrickHasTheMiddleOfAFinerOne)
{
  for (const i64vec3& dims : Sizes) {
    const inr::Hierarchy levels(dims, 40);
    for (int k = 0; k < 200; ++k) {
      for (int level = 0; level + 1 < levels.levels(); ++level) {
        const inr::BrickId fine =
            levels.locate(level, RandomPoint(dims, static_cast<std::uint64_t>(k))).brick;
        const inr::BrickId coarse = levels.coarser(fine);
        const dvec3 first(levels.firstVoxel(fine));
        const dvec3 end = glm::min(first + dvec3(levels.brickDims() - 1),
                                   dvec3(levels.size(level) - std::int64_t{1}));
        const dvec3 middle = (0.5 * (first + end) - levels.bias(level)) / levels.scale(level);
        EXPECT_EQ(levels.locate(level + 1, middle).brick.at, coarse.at);
        EXPECT_EQ(coarse.level, level + 1);
      }
    }
  }
}

TEST(Hierarchy, EveryVoxelIsInABrickAndNeighboursShareALayer)
{
  for (const int edge : {4, 7, 40}) {
    for (const std::int64_t voxels : {1, 2, 3, 4, 5, 39, 40, 41, 79, 80, 118, 256}) {
      const inr::Hierarchy levels(i64vec3(voxels), edge);
      const std::int64_t bricks = levels.bricks(0).x;
      const std::int64_t stored = levels.brickDims().x;
      const std::int64_t last = levels.firstVoxel({0, i64vec3(bricks - 1)}).x;
      EXPECT_GE(last + stored, voxels);
      EXPECT_LT(last, std::max<std::int64_t>(voxels - 1, 1)); // none that holds but a shared layer
      EXPECT_EQ(levels.firstVoxel({0, i64vec3(1)}).x, stored - 1);
    }
  }
}

TEST(Hierarchy, LocatesAPointAtItsPlaceInEveryLevel)
{
  for (const i64vec3& dims : Sizes) {
    const inr::Hierarchy levels(dims, 40);
    for (int level = 0; level < levels.levels(); ++level) {
      for (std::uint64_t k = 0; k < 200; ++k) {
        const dvec3 index = RandomPoint(dims, k);
        const inr::Hierarchy::Location place = levels.locate(level, index);
        for (int axis = 0; axis < 3; ++axis) {
          const auto size = static_cast<double>(levels.size(level)[axis]);
          const double u = (index[axis] + 0.5) / static_cast<double>(dims[axis]);
          const double expected = std::min(std::max(u * size - 0.5, 0.0), size - 1);
          const double voxel =
              place.local[axis] + static_cast<double>(levels.firstVoxel(place.brick)[axis]);
          EXPECT_NEAR(voxel, expected, 1e-9 * size);
          EXPECT_GE(place.local[axis], 0);
          EXPECT_LE(place.local[axis], levels.brickDims()[axis] - 1);
          EXPECT_LT(place.brick.at[axis], levels.bricks(level)[axis]);
        }
      }
    }
  }
}

/// Where a level of `size` voxels shows position `voxel`: the definition, in whole numbers.
std::int64_t BrickByDefinition(std::int64_t voxel, std::int64_t size, std::int64_t stride)
{
  std::int64_t brick = 0;
  const std::int64_t first = std::min(voxel, std::max<std::int64_t>(size - 2, 0));
  while ((brick + 1) * stride <= first) {
    ++brick;
  }
  return brick;
}

TEST(Hierarchy, EveryVoxelOfASmallVolumeIsWhereTheDefinitionPutsIt)
{
  for (const int edge : {4, 5, 8}) {
    for (std::int64_t voxels = 1; voxels < 70; ++voxels) {
      const inr::Hierarchy levels({voxels, 3, 1}, edge);
      for (int level = 0; level < levels.levels(); ++level) {
        const std::int64_t size = levels.size(level).x;
        const std::int64_t stride = levels.brickDims().x - 1;
        for (std::int64_t v = 0; v < size; ++v) {
          // Just above the voxel, so that rounding cannot decide.
          const double place =
              std::min(static_cast<double>(v) + 1e-7, static_cast<double>(size - 1));
          const double index = (place - levels.bias(level).x) / levels.scale(level).x;
          const auto brick = levels.locate(level, {index, 0, 0}).brick.at.x;
          ASSERT_EQ(brick, BrickByDefinition(v, size, stride)) << voxels << ' ' << v;
          ASSERT_LT(brick, levels.bricks(level).x);
        }
        ASSERT_EQ(BrickByDefinition(size - 1, size, stride), levels.bricks(level).x - 1);
      }
    }
  }
}

// Trilinear weights of voxel pairs make a linear field whole, whichever brick serves the sample.
TEST(Hierarchy, ALinearFieldIsContinuousAcrossTheFacesOfEveryLevel)
{
  for (const i64vec3& dims : Sizes) {
    const inr::Hierarchy levels(dims, 40);
    for (int level = 0; level < levels.levels(); ++level) {
      const std::int64_t stride = levels.brickDims().x - 1;
      const std::int64_t bricks = levels.bricks(level).x;
      for (const std::int64_t face : {std::int64_t{1}, bricks / 2, bricks - 1}) {
        if (face < 1 || face >= bricks) {
          continue;
        }
        const double step = 1e-6;
        for (const double offset : {-step, 0.0, step}) {
          const double place = static_cast<double>(face * stride) + offset;
          const double index = (place - levels.bias(level).x) / levels.scale(level).x;
          const inr::Hierarchy::Location at = levels.locate(level, {index, 0, 0});
          const double value = static_cast<double>(at.brick.at.x * stride) + at.local.x;
          EXPECT_NEAR(value, place, 1e-9 * static_cast<double>(levels.size(level).x));
          if (offset != 0) { // exactly on the face either is right
            EXPECT_EQ(at.brick.at.x, offset < 0 ? face - 1 : face) << level;
          }
        }
      }
    }
  }
}

std::vector<int> PointsOf(const inr::Hierarchy& levels)
{
  std::vector<int> points;
  for (int level = 0; level < levels.levels(); ++level) {
    points.push_back(levels.points(level));
  }
  return points;
}

TEST(Hierarchy, AsksForOnePointWhereAVoxelSpansFewCellsOfTheField)
{
  using Points = std::vector<int>;
  EXPECT_EQ(PointsOf({i64vec3(256), 40, i64vec3(308)}),
            Points({1, 1, 2, 2})); // 1.2, 2.4, 4.8, 9.6 cells
  EXPECT_EQ(PointsOf({i64vec3(256), 40, i64vec3(320)}), Points({1, 1, 2, 2})); // 2.5 just yet
  EXPECT_EQ(PointsOf({i64vec3(256), 40, i64vec3(321)}), Points({1, 2, 2, 2}));
  EXPECT_EQ(PointsOf({i64vec3(1024), 40, i64vec3(308)}), Points({1, 1, 1, 1, 2, 2}));
  EXPECT_EQ(PointsOf({i64vec3(256), 40, i64vec3(9999)}),
            Points({1, 2, 2, 2}));                               // voxels of level 0 are points
  EXPECT_EQ(PointsOf({i64vec3(256), 40}), Points({1, 2, 2, 2})); // nothing is known
  EXPECT_EQ(PointsOf({{256, 256, 100}, 40, i64vec3(308)}), Points({1, 2, 2, 2})); // 6.2 along z
  EXPECT_EQ(PointsOf({{256, 256, 100}, 40, {256, 256, 100}}), Points({1, 1, 2, 2}));
}

TEST(Hierarchy, LeavesOutLevelsThatCostAsMuchAsTheNext)
{
  const inr::Hierarchy levels(i64vec3(1024), 40, i64vec3(308));
  std::vector<bool> onTheWay;
  for (int level = 0; level < levels.levels(); ++level) {
    onTheWay.push_back(levels.view().isOnTheWay(level));
  }
  EXPECT_EQ(onTheWay, std::vector<bool>({true, true, true, true, false, true}));
}

TEST(Hierarchy, CountsTheBricksOfLargeVolumes)
{
  const inr::Hierarchy wide({10240, 7680, 1536}, 40);
  EXPECT_EQ(wide.bricks(0), i64vec3(263, 197, 40)); // (n - 1)/39, rounded up
  EXPECT_EQ(wide.levels(), 9);                      // 10240 / 2^8 = 40
  EXPECT_EQ(wide.size(8), i64vec3(40, 30, 6));
  const inr::Hierarchy huge(i64vec3(131072), 40);
  EXPECT_EQ(huge.bricks(0), i64vec3(3361));
  EXPECT_EQ(huge.levels(), 13);
}

TEST(Hierarchy, RefusesNonsense)
{
  EXPECT_THROW(inr::Hierarchy({0, 1, 1}, 40), inr::Error);
  EXPECT_THROW(inr::Hierarchy({9, 9, 9}, 3), inr::Error);
  EXPECT_THROW(inr::Hierarchy({9, 9, 9}, 1025), inr::Error);
  EXPECT_THROW(inr::Hierarchy({std::int64_t{1} << 40, 1, 1}, 40), inr::Error);
}

} // namespace test::hierarchy
