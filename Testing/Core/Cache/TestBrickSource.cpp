// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickSource.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <atomic>

namespace test::brick_source {

float Linear(const glm::vec3& u) { return 0.1f + 0.2f * u.x + 0.3f * u.y + 0.4f * u.z; }

std::vector<float> Infer(const inr::Hierarchy& levels, FieldEvaluator::Function field,
                         const inr::BrickId& id, int threads = 2)
{
  const inr::Arena arena(threads);
  const auto source =
      inr::MakeBrickSource(std::make_shared<FieldEvaluator>(std::move(field)), levels);
  std::vector<float> values(static_cast<std::size_t>(levels.voxelsPerBrick()));
  const inr::BrickKey key = inr::KeyOf(id);
  source->infer(&key, 1, values.data(), arena);
  return values;
}

/// Calls `check(voxel of the level, value)` for all voxels of a brick.
template <typename Check>
void ForEachVoxel(const inr::Hierarchy& levels, const inr::BrickId& id,
                  const std::vector<float>& values, const Check& check)
{
  const glm::i64vec3 dims(levels.brickDims());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto index = static_cast<std::int64_t>(k);
    const glm::i64vec3 within = inr::GridPlace(index, dims);
    check(levels.firstVoxel(id) + within, values[k]);
  }
}

// The mean of a linear field over a voxel is its value at the voxel's centre.
TEST(BrickSource, HoldsALinearFieldAtEveryLevel)
{
  const inr::Hierarchy levels({37, 22, 9}, 8);
  for (int level = 0; level < levels.levels(); ++level) {
    const inr::BrickId id{level, levels.bricks(level) - std::int64_t{1}}; // with a rim
    const glm::i64vec3 last = levels.size(level) - std::int64_t{1};
    ForEachVoxel(levels, id, Infer(levels, Linear, id), [&](const glm::i64vec3& v, float value) {
      const glm::dvec3 inside(glm::min(v, last));
      const glm::vec3 u((inside + 0.5) / glm::dvec3(levels.size(level)));
      EXPECT_NEAR(value, Linear(u), 1e-6) << level;
    });
  }
}

TEST(BrickSource, FiltersWhatACoarseVoxelCannotShow)
{
  const inr::Hierarchy levels({64, 64, 64}, 8);
  const auto stripes = [](const glm::vec3& u) { // one voxel wide
    return static_cast<float>(static_cast<int>(u.x * 64) % 2);
  };
  const inr::BrickId id{1, {0, 0, 0}};
  ForEachVoxel(levels, id, Infer(levels, stripes, id),
               [](const glm::i64vec3&, float value) { EXPECT_EQ(value, 0.5f); });
}

// Where it tells at most 2.5 places apart in a voxel; else a coarse one is the mean of eight.
TEST(BrickSource, TakesTheCentreWhereTheFieldIsSmoothInIt)
{
  const inr::Hierarchy levels({64, 64, 64}, 8, glm::i64vec3(80));
  const auto bowl = [](const glm::vec3& u) { return u.x * u.x; };
  for (int level = 0; level < levels.levels(); ++level) {
    const double size = 64 >> level;
    const double off = level < 2 ? 0 : 0.25 / size; // whose mean is further up
    ForEachVoxel(levels, {level, {0, 0, 0}}, Infer(levels, bowl, {level, {0, 0, 0}}),
                 [&](const glm::i64vec3& v, float value) {
                   const double u = (static_cast<double>(v.x) + 0.5) / size;
                   EXPECT_NEAR(value, u * u + off * off, 1e-6) << level;
                 });
  }
}

// Nobody knows what a field is beside the only plane of its voxels.
TEST(BrickSource, AsksASlabInItsMiddleOnly)
{
  const inr::Hierarchy levels({40, 1, 40}, 8);
  const auto plane = [](const glm::vec3& u) { return u.y == 0.5f ? 0.25f : 1.0f; };
  for (int level = 0; level < levels.levels(); ++level) {
    for (const float value : Infer(levels, plane, {level, {0, 0, 0}})) {
      EXPECT_EQ(value, 0.25f) << level;
    }
  }
}

TEST(BrickSource, ClampsToTheNormalisedRange)
{
  const inr::Hierarchy levels({16, 16, 16}, 8);
  const auto wild = [](const glm::vec3& u) { return u.x < 0.5f ? -3.0f : 5.0f; };
  for (const float value : Infer(levels, wild, {0, {0, 0, 0}})) {
    EXPECT_TRUE(value == 0.0f || value == 1.0f);
  }
}

// What is beyond a level's voxels is a copy and costs nothing, along z where layers are, too.
TEST(BrickSource, AsksForEachPointOnce)
{
  const inr::Hierarchy levels({37, 22, 25}, 8);
  for (int level = 0; level < levels.levels(); ++level) {
    const inr::BrickId id{level, levels.bricks(level) - std::int64_t{1}};
    std::atomic<std::int64_t> asked{0};
    Infer(
        levels,
        [&](const glm::vec3&) {
          ++asked;
          return 0.5f;
        },
        id);
    const glm::i64vec3 inside =
        glm::min(glm::i64vec3(levels.brickDims()), levels.size(level) - levels.firstVoxel(id));
    const std::int64_t points = inside.x * inside.y * inside.z * (level == 0 ? 1 : 8);
    EXPECT_EQ(asked, points) << level;
    const auto source = inr::MakeBrickSource(std::make_shared<FieldEvaluator>(Linear), levels);
    EXPECT_EQ(source->points(inr::KeyOf(id)), points) << level;
  }
}

TEST(BrickSource, NeighboursAgreeOnTheLayerTheyShareBitForBit)
{
  const inr::Hierarchy levels({100, 100, 100}, 8);
  const auto wave = [](const glm::vec3& u) { return 0.5f + 0.5f * std::sin(50 * u.x * u.y); };
  const std::vector<float> left = Infer(levels, wave, {0, {3, 4, 5}}, 1);
  const std::vector<float> right = Infer(levels, wave, {0, {4, 4, 5}}, 2);
  for (std::size_t row = 0; row < 64; ++row) {
    EXPECT_EQ(left[8 * row + 7], right[8 * row]);
  }
}

} // namespace test::brick_source
