// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickBlocks.h"
#include "Core/Random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace test::brick_blocks {

constexpr inr::CachePrecision Precisions[] = {
    inr::CachePrecision::Float32, inr::CachePrecision::Bits16, inr::CachePrecision::Bits8};

/// Values that are different from block to block.
std::vector<float> Brick(const glm::ivec3& dims, std::uint64_t seed)
{
  std::vector<float> values;
  for (int z = 0; z < dims.z; ++z) {
    for (int y = 0; y < dims.y; ++y) {
      for (int x = 0; x < dims.x; ++x) {
        const auto block = static_cast<std::uint64_t>(x / 5 + 100 * (y / 4) + 10000 * (z / 6));
        const float own = inr::RandomUnit(seed, static_cast<std::uint64_t>(values.size()));
        values.push_back(0.2f + 0.6f * inr::RandomUnit(seed + 1, block) + 0.05f * own);
      }
    }
  }
  return values;
}

struct Stored
{
  Stored(inr::CachePrecision precision, const glm::ivec3& dims)
      : dims(dims), pool(precision, std::int64_t{1} * dims.x * dims.y * dims.z, 4),
        blocks(precision, dims, 4)
  {
    this->pool.resize(4);
    this->blocks.resize(4);
  }

  void store(std::int32_t slot, std::uint64_t seed)
  {
    this->pool.store(slot, Brick(this->dims, seed).data());
    this->blocks.store(slot, this->pool.view(slot), inr::BlockSet::all());
  }
  double voxel(std::int32_t slot, const glm::ivec3& at) const
  {
    const inr::BrickView view = this->pool.view(slot);
    const std::int64_t k = at.x + std::int64_t{this->dims.x} * (at.y + this->dims.y * at.z);
    switch (this->pool.precision()) {
    case inr::CachePrecision::Float32:
      return static_cast<const float*>(view.voxels)[k];
    case inr::CachePrecision::Bits16:
      return view.low + double{view.step} * static_cast<const std::uint16_t*>(view.voxels)[k];
    default:
      return view.low + double{view.step} * static_cast<const std::uint8_t*>(view.voxels)[k];
    }
  }

  glm::ivec3 dims;
  inr::BrickPool pool;
  inr::BrickBlocks blocks;
};

/// Of the voxels of a block, those that it shares with its neighbours included.
inr::ValueRange RangeOf(const Stored& stored, std::int32_t slot, const glm::ivec3& block)
{
  const inr::BlockLattice& lattice = stored.blocks.lattice();
  double low = 1e9;
  double high = -1e9;
  glm::ivec3 at;
  const glm::ivec3 first = block * lattice.edge;
  const glm::ivec3 last = glm::min(first + lattice.edge, stored.dims - 1);
  for (at.z = first.z; at.z <= last.z; ++at.z) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.x = first.x; at.x <= last.x; ++at.x) {
        low = std::min(low, stored.voxel(slot, at));
        high = std::max(high, stored.voxel(slot, at));
      }
    }
  }
  return {static_cast<float>(low), static_cast<float>(high)};
}

void ExpectRanges(const Stored& stored, std::int32_t slot)
{
  constexpr float margin = 0x1p-12f;
  constexpr float code = 0.85f / 256; // of all that a brick has
  const inr::BlockLattice& lattice = stored.blocks.lattice();
  std::vector<inr::ValueRange> ranges(static_cast<std::size_t>(lattice.blocks()));
  stored.blocks.ranges(slot, ranges.data());
  const inr::ValueRange* range = ranges.data();
  glm::ivec3 block;
  for (block.z = 0; block.z < lattice.count.z; ++block.z) {
    for (block.y = 0; block.y < lattice.count.y; ++block.y) {
      for (block.x = 0; block.x < lattice.count.x; ++block.x, ++range) {
        const inr::ValueRange truth = RangeOf(stored, slot, block);
        // As wide as said, but for the last place.
        EXPECT_LE(range->low, truth.low - 0.999f * margin);
        EXPECT_GE(range->high, truth.high + 0.999f * margin);
        EXPECT_GE(range->low, truth.low - 1.001f * margin - code);
        EXPECT_LE(range->high, truth.high + 1.001f * margin + code);
      }
    }
  }
}

const glm::ivec3 Shapes[] = {{40, 40, 40}, {2, 2, 2},   {7, 6, 5},       {41, 9, 33},
                             {100, 3, 17}, {5, 200, 2}, {33, 1 + 32, 40}};

TEST(BrickBlocks, CoverABrick)
{
  for (const glm::ivec3& dims : Shapes) {
    const inr::BlockLattice lattice(dims);
    EXPECT_GE(lattice.edge, 4);
    for (int axis = 0; axis < 3; ++axis) {
      const int cells = dims[axis] - 1;
      EXPECT_LE(lattice.count[axis], inr::BlockLattice::Most);
      EXPECT_GE(lattice.count[axis] * lattice.edge, cells);
      EXPECT_LT((lattice.count[axis] - 1) * lattice.edge, cells);
    }
  }
  EXPECT_EQ(inr::BlockLattice({40, 40, 40}).edge, 5);
  EXPECT_EQ(inr::BlockLattice({40, 40, 40}).blocks(), 512);
  EXPECT_EQ(inr::BlockLattice({1024, 1024, 1024}).edge, 128);
}

TEST(BrickBlocks, BoundTheirVoxels)
{
  for (const inr::CachePrecision precision : Precisions) {
    for (const glm::ivec3& dims : Shapes) {
      Stored stored(precision, dims);
      stored.store(2, 7);
      ExpectRanges(stored, 2);
    }
  }
}

TEST(BrickBlocks, StayWithTheirBricks)
{
  for (const inr::CachePrecision precision : Precisions) {
    Stored stored(precision, {9, 12, 7});
    stored.store(0, 1);
    stored.store(3, 2);
    stored.store(1, 3);
    stored.pool.copy(3, 0);
    stored.blocks.copy(3, 0);
    ExpectRanges(stored, 0);
    ExpectRanges(stored, 1);
    ExpectRanges(stored, 3);
  }
}

// Constant, or of a range that is next to none.
TEST(BrickBlocks, HoldWhatHardlyVaries)
{
  constexpr glm::ivec3 dims(9, 9, 9);
  for (const inr::CachePrecision precision : Precisions) {
    for (const float width : {0.0f, 1e-44f, 1e-38f, 1e-30f}) {
      inr::BrickPool pool(precision, 729, 1);
      inr::BrickBlocks blocks(precision, dims, 1);
      pool.resize(1);
      blocks.resize(1);
      std::vector<float> values(729, 0.0f);
      values[700] = width;
      pool.store(0, values.data());
      blocks.store(0, pool.view(0), inr::BlockSet::all());
      inr::ValueRange ranges[8];
      blocks.ranges(0, ranges);
      for (const inr::ValueRange& range : ranges) {
        EXPECT_LT(range.low, 0.0f);
        EXPECT_GT(range.high, width);
        EXPECT_LT(range.high, 1e-3f);
      }
    }
  }
}

} // namespace test::brick_blocks
