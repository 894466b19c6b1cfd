// SPDX-License-Identifier: BSD-3-Clause
//
// Bricks of which some blocks are inferred: against the whole ones, and what becomes of them.
#include "Core/Cache/BrickStore.h"
#include "Core/Random.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>

namespace test::brick_parts {

float Wave(const glm::vec3& u)
{
  return 0.5f + 0.5f * std::sin(31 * u.x + 17 * u.y) * std::cos(23 * u.z);
}

/// Each block with a chance of `share`, all of a lattice that has them.
inr::BlockSet RandomBlocks(const inr::BlockLattice& lattice, double share, std::uint64_t seed)
{
  inr::BlockSet set;
  std::uint64_t drawn = 0;
  for (int z = 0; z < lattice.count.z; ++z) {
    for (int y = 0; y < lattice.count.y; ++y) {
      for (int x = 0; x < lattice.count.x; ++x) {
        if (inr::RandomUnit(seed, ++drawn) < share) {
          set.add({x, y, z});
        }
      }
    }
  }
  return set;
}

/// Whether a voxel is one of some blocks', of those that begin at `end` or before.
bool IsIn(const inr::BlockSet& set, const inr::BlockLattice& lattice, const glm::ivec3& voxel,
          const glm::ivec3& end)
{
  for (int z = 0; z < lattice.count.z; ++z) {
    for (int y = 0; y < lattice.count.y; ++y) {
      for (int x = 0; x < lattice.count.x; ++x) {
        const glm::ivec3 first = glm::ivec3(x, y, z) * lattice.edge;
        const glm::ivec3 last = first + lattice.edge;
        if (set.has({x, y, z}) && glm::all(glm::greaterThanEqual(voxel, first)) &&
            glm::all(glm::lessThanEqual(voxel, last)) && glm::all(glm::lessThanEqual(first, end))) {
          return true;
        }
      }
    }
  }
  return false;
}

TEST(BlockLattice, SaysWhichBlocksShareAVoxel)
{
  for (const int size : {2, 4, 5, 9, 13, 17, 39, 40, 41, 1024}) {
    const inr::BlockLattice lattice(glm::ivec3(size, std::max(size / 2, 2), 2));
    for (int axis = 0; axis < 3; ++axis) {
      for (int voxel = 0; voxel <= lattice.lastVoxel[axis]; ++voxel) {
        const inr::BlockLattice::Span blocks = lattice.blocksAt(voxel, axis);
        for (int block = 0; block < lattice.count[axis]; ++block) {
          const inr::BlockLattice::Span voxels = lattice.voxelsOf({block, block}, axis);
          const bool shares = voxels.first <= voxel && voxel <= voxels.last;
          EXPECT_EQ(shares, blocks.first <= block && block <= blocks.last) << size << " " << voxel;
        }
      }
    }
  }
}

// Of volumes that end within bricks and blocks, at all levels.
TEST(BrickParts, AreAsInWholeBricks)
{
  std::int64_t known = 0;
  std::int64_t unknown = 0;
  std::uint64_t seed = 0;
  for (const auto& [dims, edge] :
       {std::pair(glm::i64vec3(37, 22, 25), 8), std::pair(glm::i64vec3(61, 45, 50), 17),
        std::pair(glm::i64vec3(90, 3, 44), 40), std::pair(glm::i64vec3(50, 60, 1), 22)}) {
    const inr::Hierarchy levels(dims, edge);
    std::atomic<std::int64_t> asked{0};
    const auto source = inr::MakeBrickSource(
        std::make_shared<FieldEvaluator>([&](const glm::vec3& u) { return ++asked, Wave(u); }),
        levels);
    ASSERT_TRUE(source->infersParts());
    for (int round = 0; round < 60; ++round) {
      const int level = round % levels.levels();
      const glm::i64vec3& bricks = levels.bricks(level);
      const glm::i64vec3 at(round % bricks.x, round / 3 % bricks.y, round / 7 % bricks.z);
      const inr::BrickKey key = inr::KeyOf({level, at});
      const double share = round % 3 == 0 ? 0.03 : 0.5;
      const inr::BrickPart part(key, RandomBlocks(source->blocks(), share, ++seed));
      std::vector<float> whole(static_cast<std::size_t>(levels.voxelsPerBrick()));
      std::vector<float> values(whole.size(), -7.0f);
      source->infer(&key, 1, whole.data(), inr::Arena(1));
      asked = 0;
      source->inferParts(&part, 1, values.data(), inr::Arena(2));
      EXPECT_LE(asked, source->points(inr::BrickPart(key)));
      EXPECT_EQ(asked, source->points(part));
      std::set<float> seen;
      for (std::size_t k = 0; k < whole.size(); ++k) {
        const auto index = static_cast<int>(k);
        const glm::ivec3 size = levels.brickDims();
        const glm::ivec3 voxel(index % size.x, index / size.x % size.y, index / size.x / size.y);
        // Layers beyond the volume are copies of the last one, known or not.
        const glm::ivec3 last(levels.size(level) - std::int64_t{1} -
                              levels.firstVoxel({level, at}));
        if (voxel.x > last.x || voxel.y > last.y) {
          continue; // nothing is made of what is beyond it
        }
        const bool isKnown = IsIn(part.blocks, source->blocks(),
                                  {voxel.x, voxel.y, std::min(voxel.z, last.z)}, last);
        if (isKnown) {
          ASSERT_EQ(values[k], whole[k]) << round << ": " << k;
          seen.insert(values[k]);
        } else {
          ++unknown;
        }
        known += isKnown ? 1 : 0;
      }
      for (const float value : values) { // so that what is stored is as exact as it can be
        ASSERT_TRUE(seen.empty() || seen.count(value) > 0) << round;
      }
    }
  }
  EXPECT_GT(known, 100000);
  EXPECT_GT(unknown, 100000);
}

class Stored : public testing::Test
{
protected:
  static constexpr glm::i64vec3 Dims{60, 45, 52};

  inr::BrickKey key(std::int64_t x) const { return inr::KeyOf({0, {x, 0, 0}}); }
  const inr::BlockSet& known(std::int64_t x) const
  {
    const inr::BrickCache& cache = this->Store.cache();
    return cache.blocks().known(cache.find(this->key(x)));
  }
  /// All of the first brick's voxels, stored as floats.
  std::vector<float> voxels() const
  {
    const inr::BrickCache& cache = this->Store.cache();
    const auto* first = static_cast<const float*>(cache.view(cache.find(this->key(0))).voxels);
    return {first, first + this->Levels.voxelsPerBrick()};
  }

  inr::Arena Threads{2};
  inr::Hierarchy Levels{Dims, 17};
  std::shared_ptr<const inr::BrickSource> Source =
      inr::MakeBrickSource(std::make_shared<FieldEvaluator>(Wave), this->Levels);
  inr::BrickStore Store{
      inr::CacheBudget::ofProcess(), this->Source, inr::CachePrecision::Float32, 64 << 20, true, 2};
  inr::BlockSet Some = RandomBlocks(this->Source->blocks(), 0.3, 1);
  inr::BlockSet Others = RandomBlocks(this->Source->blocks(), 0.3, 2);
};

TEST_F(Stored, PartsAreCompletedWhenTheyAreAskedForAgain)
{
  const inr::BrickStore::Call call(this->Store, this->Threads);
  const std::int64_t before = this->Store.mapped();
  this->Store.load({{this->key(0), this->Some}, this->key(1)}, this->Threads, {});
  EXPECT_TRUE(this->known(0) == this->Some);
  EXPECT_TRUE(this->known(1).isAll());
  EXPECT_EQ(call.done().points, this->Source->points({this->key(0), this->Some}) +
                                    this->Source->points(this->key(1)) +
                                    this->Source->points(this->Levels.coarsest()));
  const std::uint64_t arrival = this->Store.cache().arrival(this->Store.cache().find(this->key(0)));

  this->Store.load({{this->key(0), this->Others}}, this->Threads, {});
  EXPECT_TRUE(this->known(0).isAll());
  EXPECT_EQ(this->Store.mapped(), before + 2);
  EXPECT_GT(this->Store.cache().arrival(this->Store.cache().find(this->key(0))), arrival);
  std::vector<float> whole(static_cast<std::size_t>(this->Levels.voxelsPerBrick()));
  const inr::BrickKey key = this->key(0);
  this->Source->infer(&key, 1, whole.data(), this->Threads);
  EXPECT_EQ(this->voxels(), whole);
}

TEST_F(Stored, PartsComeFromTheLoaderToo)
{
  const inr::BrickStore::Call call(this->Store, this->Threads);
  this->Store.loadFor(1e9, {{this->key(0), this->Some}}, this->Threads);
  EXPECT_TRUE(this->known(0) == this->Some);
  std::vector<float> part(static_cast<std::size_t>(this->Levels.voxelsPerBrick()));
  const inr::BrickPart wanted(this->key(0), this->Some);
  this->Source->inferParts(&wanted, 1, part.data(), this->Threads);
  EXPECT_EQ(this->voxels(), part);

  this->Store.loadFor(1e9, {{this->key(0), this->Others}}, this->Threads);
  EXPECT_TRUE(this->known(0).isAll());
}

TEST(BrickParts, TakeThePlaceOfThoseThatKnowLess)
{
  const inr::Hierarchy levels({60, 45, 52}, 17);
  inr::BrickCache cache(levels, inr::CachePrecision::Float32, 64 << 20);
  const inr::BlockLattice lattice(levels.brickDims());
  std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()), 0.5f);
  const inr::BrickKey key = inr::KeyOf({0, {1, 1, 1}});
  const inr::BlockSet some = RandomBlocks(lattice, 0.5, 3);
  EXPECT_TRUE(cache.lacks({key, some}));
  EXPECT_TRUE(cache.insert({key, some}, values.data()));
  const std::int32_t slot = cache.find(key);
  cache.pin(key);
  const std::uint64_t arrival = cache.arrival(slot);
  // What comes late, of an earlier wish, would take something away.
  EXPECT_FALSE(cache.lacks({key, some}));
  EXPECT_FALSE(cache.lacks({key, RandomBlocks(lattice, 0.5, 4)}));
  EXPECT_TRUE(cache.lacks(key));
  std::fill(values.begin(), values.end(), 0.25f);
  EXPECT_TRUE(cache.insert(key, values.data()));
  EXPECT_FALSE(cache.lacks(key));
  EXPECT_TRUE(cache.blocks().known(slot).isAll());
  EXPECT_GT(cache.arrival(slot), arrival);
  EXPECT_EQ(*static_cast<const float*>(cache.view(slot).voxels), 0.25f);
  EXPECT_EQ(cache.mapped(), 1);
  cache.beginFrame(100);
  EXPECT_EQ(cache.oldestUse(inr::BrickCache::Pinned), inr::BrickCache::Pinned); // as it was
}

TEST(BrickParts, MoveWithTheirBricks)
{
  const inr::Hierarchy levels({60, 45, 52}, 17);
  inr::BrickCache cache(levels, inr::CachePrecision::Bits16, 64 << 20);
  const inr::BlockLattice lattice(levels.brickDims());
  const std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()), 0.5f);
  const auto key = [](std::int64_t x) { return inr::KeyOf({0, {x, 0, 0}}); };
  for (std::int64_t x = 0; x < 3; ++x) {
    cache.beginFrame(static_cast<std::uint64_t>(x) + 1);
    const auto seed = static_cast<std::uint64_t>(x);
    ASSERT_TRUE(cache.insert({key(x), RandomBlocks(lattice, 0.5, seed)}, values.data()));
  }
  const std::int32_t gone = cache.find(key(0));
  cache.evict(2);
  ASSERT_EQ(cache.find(key(2)), gone); // the last one takes the place of the first
  EXPECT_TRUE(cache.blocks().known(gone) == RandomBlocks(lattice, 0.5, 2));
}

// Cells that a brick reaches into, and no others: whatever part of it is inferred.
TEST(BrickParts, AreWithinTheRangesOfTheirCells)
{
  const glm::i64vec3 dims(64, 48, 40);
  auto cells = std::make_shared<inr::MacroCells>(inr::MakeMacroCells(dims, 16));
  for (std::size_t k = 0; k < cells->ranges.size(); ++k) {
    const auto low = static_cast<float>(0.01 * static_cast<double>(k));
    cells->ranges[k] = {low, low + 0.001f};
  }
  cells->ranges[0] = {}; // of a cell without values
  const inr::Hierarchy levels(dims, 17);
  const auto source = inr::MakeBrickSource(std::make_shared<FieldEvaluator>(Wave), levels, cells);
  const auto expect = [&](const inr::BrickId& id, const glm::i64vec3& first,
                          const glm::i64vec3& last) {
    const inr::ValueRange range = source->rangeOf(inr::KeyOf(id));
    const auto at = [&](const glm::i64vec3& cell) {
      return cells->ranges[static_cast<std::size_t>(cells->index(cell.x, cell.y, cell.z))];
    };
    EXPECT_EQ(range.low, at(first).low) << id.level;
    EXPECT_EQ(range.high, at(last).high) << id.level;
  };
  expect({0, {0, 0, 0}}, {1, 0, 0}, {1, 1, 1});
  expect({0, {1, 1, 1}}, {1, 1, 1}, {2, 2, 2});
  expect({0, {3, 2, 2}}, {3, 2, 2}, {3, 2, 2});
  expect({1, {1, 0, 0}}, {2, 0, 0}, {3, 2, 2});
  EXPECT_TRUE(inr::MakeBrickSource(std::make_shared<FieldEvaluator>(Wave), levels)
                  ->rangeOf(levels.coarsest())
                  .empty());
}

} // namespace test::brick_parts
