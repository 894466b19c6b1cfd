// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickSource.h"
#include "Core/Cache/LevelErrors.h"
#include "Core/Cache/LevelResampling.h"
#include "Core/Model/MacroCells.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using Field = FieldEvaluator::Function;

/// Level `level` of a field as the cache's bricks have it, linear between its voxels.
class BrickedLevel
{
public:
  BrickedLevel(const Field& field, const glm::i64vec3& dims, int level)
      : Levels(dims, 4), Level(level),
        Source(inr::MakeBrickSource(std::make_shared<FieldEvaluator>(field), Levels))
  {}

  double at(const glm::dvec3& voxel) const
  {
    const inr::Hierarchy::Location place = this->Levels.locate(this->Level, voxel);
    std::vector<float> values(static_cast<std::size_t>(this->Levels.voxelsPerBrick()));
    const inr::BrickKey key = inr::KeyOf(place.brick);
    this->Source->infer(&key, 1, values.data(), inr::Arena(1));
    const glm::i64vec3 dims(this->Levels.brickDims());
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      glm::i64vec3 at;
      for (int axis = 0; axis < 3; ++axis) {
        const double floor = std::floor(place.local[axis]);
        const double part = place.local[axis] - floor;
        const bool far = (corner >> axis & 1) != 0;
        at[axis] = std::min(static_cast<std::int64_t>(floor) + (far ? 1 : 0), dims[axis] - 1);
        weight *= far ? part : 1 - part;
      }
      sum += weight * values[static_cast<std::size_t>(at.x + dims.x * (at.y + dims.y * at.z))];
    }
    return sum;
  }

private:
  inr::Hierarchy Levels;
  int Level;
  std::shared_ptr<const inr::BrickSource> Source;
};

/// Voxels without any order, linear in between.
Field RoughField(const glm::i64vec3& dims)
{
  const Voxels voxels(dims, [](const glm::vec3& u) {
    return static_cast<float>(inr::RandomUnit(7, static_cast<std::uint64_t>(1e4 * u.x) * 1000003 +
                                                     static_cast<std::uint64_t>(1e4 * u.y) * 10007 +
                                                     static_cast<std::uint64_t>(1e4 * u.z)));
  });
  return [voxels](const glm::vec3& u) { return voxels.at(u); };
}

TEST(LevelResampling, HasWhatBricksHave)
{
  for (const glm::i64vec3& dims : {glm::i64vec3(21, 16, 9), glm::i64vec3(14, 1, 41)}) {
    const Field field = RoughField(dims);
    const inr::VoxelSpan all[3] = {{0, dims.x - 1}, {0, dims.y - 1}, {0, dims.z - 1}};
    inr::ValueBox fine(dims);
    for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; ++k) {
      const glm::dvec3 at(k % dims.x, k / dims.x % dims.y, k / (dims.x * dims.y));
      fine.values[static_cast<std::size_t>(k)] = field(glm::vec3((at + 0.5) / glm::dvec3(dims)));
    }
    for (const int level : {1, 2, 3}) {
      const BrickedLevel truth(field, dims, level);
      const inr::ValueBox resampled =
          inr::LevelResampling(all, dims, level).apply(fine, glm::i64vec3(0));
      for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; k += 7) {
        const glm::dvec3 at(k % dims.x, k / dims.x % dims.y, k / (dims.x * dims.y));
        EXPECT_NEAR(resampled.values[static_cast<std::size_t>(k)], truth.at(at), 2e-5)
            << level << " " << k;
      }
    }
  }
}

/// Errors of all cells of a field.
inr::LevelErrors Measured(const Field& field, const glm::i64vec3& dims, int edge)
{
  const inr::MacroCells cells = inr::MakeMacroCells(dims, edge);
  inr::LevelErrors errors(dims, cells.dims, cells.spacing);
  const FieldEvaluator evaluator(field);
  for (std::int64_t block = 0; block < errors.blocks(); ++block) {
    EXPECT_FALSE(errors.isMeasured(block));
    errors.measure(block, evaluator);
    EXPECT_TRUE(errors.isMeasured(block));
  }
  return errors;
}

TEST(LevelErrors, OfASlopeAreNoneButAtTheVolumesEnds)
{
  const glm::i64vec3 dims(160, 48, 48); // two blocks
  const inr::LevelErrors errors =
      Measured([](const glm::vec3& u) { return 0.1f + 0.8f * u.x; }, dims, 16);
  EXPECT_EQ(errors.blocks(), 2);
  for (std::int64_t x = 1; x < 9; ++x) { // the blocks meet behind cell 7
    const std::int64_t inside = x + 10 * (1 + 3 * 1);
    EXPECT_EQ(errors.blockOf(inside), x < 8 ? 0 : 1);
    for (const int level : {1, 2, 3}) {
      EXPECT_LT(errors.error(inside, level).spread, 1e-6) << x;
    }
    EXPECT_NEAR(errors.slope(inside), 0.8 / 160, 1e-6) << x;
  }
  // Level 3 ends 3.5 voxels inside, with a mean that the end has pulled by half a voxel.
  EXPECT_GT(errors.error(10 * (1 + 3 * 1), 3).spread, 0.2 * 0.8 / 160);
}

TEST(LevelErrors, OfAParabolaAreThoseThatOneCalculates)
{
  const glm::i64vec3 dims(64, 64, 64);
  const double bend = 0.0002; // f = bend x^2, x in voxels from the middle
  const inr::LevelErrors errors = Measured(
      [&](const glm::vec3& u) {
        const double x = 64.0 * u.x - 32.0;
        return static_cast<float>(0.1 + bend * x * x);
      },
      dims, 16);
  const std::int64_t inside = 1 + 4 * (1 + 4 * 1);
  // A voxel of n = 2^l is the mean of two points n/4 from its centre: + bend n^2/16. Between two of
  // them, at s = 1/(2n), 3/(2n), ... of the way, the chord lies bend n^2 s (1 - s) above; and level
  // 0 has no error at its voxels.
  for (const int level : {1, 2, 3}) {
    const double n = 1 << level;
    double mean = 0;
    for (double s = 0.5 / n; s < 1; s += 1 / n) {
      mean += bend * n * n * (1.0 / 16 + s * (1 - s)) / n;
    }
    // Lines along x have 18 voxels, no multiple of n; those across have one value.
    const double highest = bend * n * n * (1.0 / 16 + (level == 1 ? 3.0 / 16 : 0.25));
    EXPECT_GE(errors.error(inside, level).mean, 0.98 * mean) << level;
    EXPECT_LE(errors.error(inside, level).mean, 1.001 * highest) << level;
    EXPECT_NEAR(errors.error(inside, level).spread, errors.error(inside, level).mean, 1e-6);
  }
}

TEST(LevelErrors, AreThoseOfTheWorstLineOfAThinFeature)
{
  const glm::i64vec3 dims(48, 48, 48);
  const Voxels voxels(dims, [](const glm::vec3& u) { // a wire along z through voxel (20, 24)
    return std::abs(48 * u.x - 20.5f) < 0.5f && std::abs(48 * u.y - 24.5f) < 0.5f ? 0.9f : 0.1f;
  });
  const inr::LevelErrors errors =
      Measured([&](const glm::vec3& u) { return voxels.at(u); }, dims, 16);
  const auto cell = [](std::int64_t x, std::int64_t y) { return x + 3 * (y + 3 * 1); };
  // Level 1 has a quarter of the wire in each of two by two voxels around it: (3/4)^2 of a quarter
  // where the wire is.
  EXPECT_NEAR(errors.error(cell(1, 1), 1).mean, 0.8 * (1 - 9.0 / 64), 1e-5);
  EXPECT_LT(errors.error(cell(2, 0), 1).spread, 1e-6); // out of reach
  EXPECT_GT(errors.error(cell(1, 1), 3).mean, 0.75);
}

} // namespace
