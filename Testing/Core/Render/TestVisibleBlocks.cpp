// SPDX-License-Identifier: BSD-3-Clause
//
// Which blocks rays can see something in: against points in visible macro-cells.
#include "Core/Random.h"
#include "Core/Render/Bricks/SufficientBricks.h"
#include "Core/Render/MacroCells/Majorants.h"
#include "Testing/Core/Render/HiddenScene.h"

#include <gtest/gtest.h>

namespace test::visible_blocks {

/// A few cells that can be seen, and the majorants of all levels.
struct Visible
{
  Visible(const glm::i64vec3& size, int cell, int brick, double share)
      : dims(size), levels(size, brick), cells(Random(size, cell, share)),
        majorants(cells, size, inr::Arena(1))
  {
    const inr::ColorTable colors(Shell(0), VolumeOf(size));
    this->majorants.update(colors, inr::Arena(1));
  }

  static inr::MacroCells Random(const glm::i64vec3& size, int edge, double share)
  {
    inr::MacroCells cells = inr::MakeMacroCells(size, edge);
    for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
      const bool isSeen = inr::RandomUnit(9, k) < share;
      cells.ranges[k] = isSeen ? inr::ValueRange{0.6f, 0.7f} : inr::ValueRange{0.1f, 0.3f};
    }
    cells.apron = 1.0 / glm::dvec3(size);
    cells.provenance = inr::MacroCellProvenance::Decoded;
    return cells;
  }

  /// The finest grid that bounds a level.
  const inr::MajorantGrid& gridOf(int level) const
  {
    int grid = 0;
    while (this->majorants.coarsestLevel(grid) < level) {
      ++grid;
    }
    return this->majorants.grid(grid);
  }

  /// Whether a point of the unit cube, moved by some voxels of the level, is in a visible cell.
  bool sees(int level, const glm::dvec3& u) const
  {
    const inr::MajorantGrid& grid = this->gridOf(level);
    const glm::i64vec3 at(glm::floor(u / grid.spacing()));
    return grid.extinction(
               grid.index(glm::clamp(at, glm::i64vec3(0), grid.dims() - std::int64_t{1}))) > 0;
  }

  glm::i64vec3 dims;
  inr::Hierarchy levels;
  inr::MacroCells cells;
  inr::Majorants majorants;
};

// All that a sample there is made of, and, with a reach, what is so many voxels from it.
TEST(VisibleBlocks, HoldWhatSamplesAreMadeOf)
{
  std::int64_t seen = 0;
  std::int64_t hidden = 0;
  std::uint64_t drawn = 0;
  const auto random = [&] { return inr::RandomUnit(5, ++drawn); };
  for (const auto& [dims, cell, brick] :
       {std::tuple(glm::i64vec3(131, 96, 77), 16, 17), std::tuple(glm::i64vec3(200, 37, 90), 8, 40),
        std::tuple(glm::i64vec3(61, 64, 1), 16, 9)}) {
    const Visible scene(dims, cell, brick, 0.05);
    for (const int reach : {0, 1}) {
      const inr::VisibleBlocks blocks(scene.levels, scene.majorants.view(), reach);
      const inr::BlockLattice lattice(scene.levels.brickDims());
      for (int round = 0; round < 20000; ++round) {
        const int level = round % scene.levels.levels();
        // A place that rays come to, in voxels of level 0.
        const glm::dvec3 index =
            glm::dvec3(random(), random(), random()) * glm::dvec3(dims - std::int64_t{1});
        const glm::dvec3 u = (index + 0.5) / glm::dvec3(dims);
        if (!scene.sees(level, u)) {
          continue;
        }
        glm::dvec3 moved = index;
        moved[round / 7 % 3] +=
            reach * (random() < 0.5 ? -1.0 : 1.0) / scene.levels.scale(level)[round / 7 % 3];
        const inr::Hierarchy::Location at = scene.levels.locate(level, moved);
        const inr::BlockSet wanted = blocks.of(inr::KeyOf(at.brick));
        const glm::ivec3 corner =
            glm::min(glm::ivec3(at.local), scene.levels.brickDims() - 2); // first of its voxels
        ASSERT_TRUE(wanted.has(corner / lattice.edge)) << level;
        ++seen;
      }
      for (std::int64_t x = 0; x < scene.levels.bricks(0).x; ++x) {
        const inr::BlockSet wanted = blocks.of(inr::KeyOf({0, {x, 0, 0}}));
        for (int block = 0; block < lattice.count.x; ++block) {
          hidden += wanted.has({block, 0, 0}) ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GT(seen, 3000);
  EXPECT_GT(hidden, 20);
}

TEST(VisibleBlocks, AreThoseThatTouchAVisibleCell)
{
  Visible scene({64, 64, 64}, 16, 65, 0); // a brick of blocks of 8 cells
  scene.cells.ranges[static_cast<std::size_t>(scene.cells.index(1, 2, 3))] = {0.6f, 0.7f};
  inr::Majorants majorants(scene.cells, scene.dims, inr::Arena(1));
  majorants.update(inr::ColorTable(Shell(0), VolumeOf(scene.dims)), inr::Arena(1));
  const inr::BlockSet wanted =
      inr::VisibleBlocks(scene.levels, majorants.view(), 0).of(inr::KeyOf({0, {0, 0, 0}}));
  for (int z = 0; z < 8; ++z) {
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        // Voxels 8 x to 8 x + 8; the cell is from voxel 15.5 to 31.5, and so on.
        const bool touches = x >= 1 && x <= 3 && y >= 3 && y <= 5 && z >= 5;
        EXPECT_EQ(wanted.has({x, y, z}), touches) << x << " " << y << " " << z;
      }
    }
  }
}

TEST(SufficientBricks, KnowWhatIsWanted)
{
  const Visible scene({64, 64, 64}, 16, 17, 0.15);
  inr::BrickCache cache(scene.levels, inr::CachePrecision::Float32, 64 << 20);
  const std::vector<float> values(static_cast<std::size_t>(scene.levels.voxelsPerBrick()), 0.5f);
  const inr::SufficientBricks whole(cache);
  const inr::VisibleBlocks visible(scene.levels, scene.majorants.view(), 0);
  const inr::SufficientBricks some(cache, visible);
  int partial = 0;
  for (std::int64_t x = 0; x < 4; ++x) {
    const inr::BrickKey key = inr::KeyOf({0, {x, 1, 2}});
    EXPECT_EQ(some.find(key), inr::PageTable::Unmapped);
    const inr::BlockSet wanted = some.wanted(key);
    EXPECT_TRUE(whole.wanted(key).isAll());
    inr::BlockSet less = wanted;
    less.words[wanted.words[0] != 0 ? 0 : 3] = 0;
    ASSERT_TRUE(cache.insert({key, less}, values.data()));
    EXPECT_EQ(some.find(key) >= 0, less.contains(wanted));
    EXPECT_EQ(whole.find(key), inr::PageTable::Unmapped);
    ASSERT_TRUE(cache.insert({key, wanted}, values.data()));
    for (int time = 0; time < 2; ++time) { // found out, and then known
      EXPECT_EQ(some.find(key), cache.find(key));
      EXPECT_EQ(whole.find(key) >= 0, wanted.isAll());
    }
    partial += wanted.isAll() ? 0 : 1;
    ASSERT_TRUE(cache.insert(key, values.data()));
    EXPECT_EQ(whole.find(key), cache.find(key));
  }
  EXPECT_GT(partial, 0);
}

} // namespace test::visible_blocks
