// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickSource.h"
#include "Core/Cache/LevelVoxels.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

namespace test::level_voxels {

float Waves(const glm::vec3& u) { return 0.5f + 0.4f * std::sin(9 * u.x + 17 * u.y * u.z + u.z); }

constexpr glm::i64vec3 Volumes[] = {{37, 22, 9}, {40, 1, 33}, {2, 1, 70}, {1, 1, 9}};

TEST(LevelVoxels, AreThoseOfBricks)
{
  const auto field = std::make_shared<FieldEvaluator>(Waves);
  for (const glm::i64vec3& dims : Volumes) {
    const inr::Hierarchy levels(dims, 8);
    const auto source = inr::MakeBrickSource(field, levels);
    for (int level = 0; level < levels.levels(); ++level) {
      const inr::LevelVoxels voxels(dims, level, levels.points(level));
      const std::vector<float> whole = voxels.in({{0, 0, 0}, levels.size(level)}, *field);
      const inr::BrickId id{level, levels.bricks(level) - std::int64_t{1}};
      const glm::i64vec3 first = levels.firstVoxel(id);
      std::vector<float> brick(static_cast<std::size_t>(levels.voxelsPerBrick()));
      const inr::BrickKey key = inr::KeyOf(id);
      source->infer(&key, 1, brick.data(), inr::Arena(1));
      for (std::int64_t k = 0; k < levels.voxelsPerBrick(); ++k) {
        const glm::i64vec3 within = inr::GridPlace(k, glm::i64vec3(levels.brickDims()));
        const glm::i64vec3 at = glm::min(first + within, levels.size(level) - std::int64_t{1});
        ASSERT_EQ(brick[static_cast<std::size_t>(k)],
                  whole[static_cast<std::size_t>(inr::GridNumber(at, levels.size(level)))]);
      }
    }
  }
}

TEST(LevelVoxels, AskNoMoreThanOncePerPoint)
{
  std::atomic<std::int64_t> asked{0};
  const FieldEvaluator field([&](const glm::vec3& u) {
    ++asked;
    return Waves(u);
  });
  for (const glm::i64vec3& dims : Volumes) {
    for (const int points : {1, 2}) {
      const inr::GridBox box{{0, 0, 0}, inr::VoxelsAtLevel(dims, 1)};
      std::int64_t expected = 1;
      for (int axis = 0; axis < 3; ++axis) {
        expected *= box.size[axis] * (dims[axis] > 1 ? points : 1);
      }
      asked = 0;
      inr::LevelVoxels(dims, 1, points).in(box, field);
      EXPECT_EQ(asked, expected);
    }
  }
}

} // namespace test::level_voxels
