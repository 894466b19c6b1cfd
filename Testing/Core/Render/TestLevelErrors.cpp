// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Cache/BrickSource.h"
#include "Core/Model/MacroCells.h"
#include "Core/Random.h"
#include "Core/Render/Tolerance/LevelErrors.h"
#include "Core/Render/Tolerance/LevelResampling.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace test::level_errors {

using Field = FieldEvaluator::Function;

/// Level `level` of a field as the cache's bricks have it, linear between its voxels.
class BrickedLevel
{
public:
  BrickedLevel(const Field& field, const glm::i64vec3& dims, int level,
               const glm::i64vec3& resolution = glm::i64vec3(0))
      : Levels(dims, 4, resolution), Level(level),
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

/// A level's voxels, in the order of their box.
inr::ValueBox VoxelsOf(const Field& field, const glm::i64vec3& size)
{
  inr::ValueBox box(size);
  for (std::int64_t k = 0; k < size.x * size.y * size.z; ++k) {
    const glm::dvec3 at(k % size.x, k / size.x % size.y, k / (size.x * size.y));
    box.values[static_cast<std::size_t>(k)] = field(glm::vec3((at + 0.5) / glm::dvec3(size)));
  }
  return box;
}

TEST(LevelResampling, HasWhatBricksHave)
{
  for (const glm::i64vec3& dims : {glm::i64vec3(21, 16, 9), glm::i64vec3(14, 1, 41)}) {
    const Field field = RoughField(dims);
    const inr::VoxelSpan all[3] = {{0, dims.x - 1}, {0, dims.y - 1}, {0, dims.z - 1}};
    for (const int level : {1, 2, 3}) {
      for (const int points : {1, 2}) {
        const BrickedLevel truth(field, dims, level, glm::i64vec3(points == 1 ? 1 : 0));
        const inr::ValueBox made =
            VoxelsOf(field, points == 1 ? inr::VoxelsAtLevel(dims, level) : dims);
        const inr::ValueBox resampled =
            inr::LevelResampling(all, dims, level, points).apply(made, glm::i64vec3(0));
        for (std::int64_t k = 0; k < dims.x * dims.y * dims.z; k += 7) {
          const glm::dvec3 at(k % dims.x, k / dims.x % dims.y, k / (dims.x * dims.y));
          EXPECT_NEAR(resampled.values[static_cast<std::size_t>(k)], truth.at(at), 2e-5)
              << level << " " << points << " " << k;
        }
      }
    }
  }
}

const inr::LevelErrors::Question Everything{
    3, 3, [](std::int64_t, const inr::LineErrors&) { return false; }};

/// Errors of all cells of a field.
inr::LevelErrors Measured(const Field& field, const glm::i64vec3& dims, int edge,
                          const std::string& kernel = {})
{
  const inr::MacroCells cells = inr::MakeMacroCells(dims, edge);
  inr::LevelErrors errors(dims, cells.dims, cells.spacing);
  const FieldEvaluator evaluator(field);
  for (std::int64_t block = 0; block < errors.blocks(); ++block) {
    errors.measure(block, evaluator, inr::LineKernelFor(inr::ChooseInstructionSet(kernel)),
                   Everything, [] {});
  }
  return errors;
}

// A field that is nothing but peaks between the voxels of level 0: at centres of voxels of level 1.
TEST(LevelErrors, SeeWhatACoarseLevelSeesBetweenVoxels)
{
  const glm::i64vec3 dims(32);
  const auto peaks = [](const glm::vec3& u) {
    const glm::vec3 at = u * 32.0f;
    return glm::length(at - glm::round(at)) < 0.1f ? 0.5f : 0.0f;
  };
  const inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  float largest[2];
  for (const int resolution : {0, 40}) { // 2.5 places a voxel of level 1
    inr::LevelErrors errors(dims, cells.dims, cells.spacing);
    const FieldEvaluator field(peaks, glm::i64vec3(resolution));
    const std::int64_t asked = errors.measure(
        0, field, inr::LineKernelFor(inr::ChooseInstructionSet("")), Everything, [] {});
    EXPECT_EQ(asked > 32 * 32 * 32, resolution > 0);
    largest[resolution > 0] = errors.of(0).levels.errors[0].largest;
  }
  EXPECT_EQ(largest[0], 0);
  EXPECT_NEAR(largest[1], 0.5, 1e-6);
}

TEST(LevelErrors, OfASlopeAreNoneButAtTheVolumesEnds)
{
  const glm::i64vec3 dims(160, 48, 48); // three blocks
  const inr::LevelErrors errors =
      Measured([](const glm::vec3& u) { return 0.1f + 0.6f * u.x + 0.2f * u.y; }, dims, 16);
  EXPECT_EQ(errors.blocks(), 3);
  for (std::int64_t x = 1; x < 9; ++x) { // blocks meet behind cells 3 and 7
    const std::int64_t inside = x + 10 * (1 + 3 * 1);
    EXPECT_EQ(errors.blockOf(inside), x / 4);
    for (const int level : {1, 2, 3}) {
      const double most = 0.2 / 48 * (1 << level) / 2;
      EXPECT_LT(errors.of(inside).levels.errors[level - 1].largest, most + 1e-6)
          << x; // a step to the middle
      EXPECT_LT(errors.of(inside).levels.errors[level - 1].sum, 1e-4 + most * (1 << level))
          << x; // and back
    }
  }
  // Level 3 ends 3.5 voxels inside, with a mean that the end has pulled by half a voxel.
  EXPECT_GT(errors.of(10 * (1 + 3 * 1)).levels.errors[2].largest, 3 * 0.6 / 160);
}

/// Along z through a field that does not change that way, all samples of a line are off by as much.
TEST(LevelErrors, AddUpAlongLinesThatCancelNothing)
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
  // 0 has no error at its voxels. From level 2 on the points are in the middle between voxels,
  // where what is linear between those lies bend/4 above.
  for (const int level : {1, 2, 3}) {
    const double n = 1 << level;
    const double middle = 0.5 - 0.5 / n; // the voxel of level 0 next to the middle of the chord
    const double highest =
        bend * (n * n * (1.0 / 16 + middle * (1 - middle)) + (level > 1 ? 0.25 : 0.0));
    const inr::LineErrors& lines = errors.of(inside).levels.errors[level - 1];
    EXPECT_GE(lines.sum, 18 * (1 - 2e-3) * highest) << level; // the cell's 16 voxels and one around
    EXPECT_LT(lines.sum, 18 * std::sqrt(3.0) * 1.1 * highest) << level;
    EXPECT_GE(lines.magnitude, lines.sum);
  }
}

/// Layers that go the way of lines, each way that is looked.
TEST(LevelErrors, AreThoseOfLayersInAnyDirection)
{
  const glm::i64vec3 dims(48, 48, 48);
  for (int number = 14; number < 27; ++number) {
    const glm::dvec3 way(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1);
    const glm::dvec3 other = way.x == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(way, other));
    const Field field = [&](const glm::vec3& u) {
      return static_cast<float>(0.5 + 0.4 * std::cos(glm::dot(48.0 * glm::dvec3(u), across)));
    };
    const inr::LineErrors lines =
        Measured(field, dims, 16).of(1 + 3 * (1 + 3 * 1)).levels.errors[2];
    // Level 3 has next to nothing of waves 6.3 voxels long.
    EXPECT_GT(lines.sum, 0.75 * 0.4 * 18 * glm::length(way)) << number;
  }
}

/// Rays go between voxels: the first one beyond a cell, on either side, is part of what they see.
TEST(LevelErrors, CountTheVoxelsNextToACell)
{
  const glm::i64vec3 dims(64, 48, 48);
  for (const int plane : {15, 32}) { // of cells of 16, those before and behind the second
    const Voxels voxels(dims, [&](const glm::vec3& u) {
      return static_cast<int>(64 * u.x) == plane ? 0.9f : 0.1f;
    });
    const inr::LevelErrors errors =
        Measured([&](const glm::vec3& u) { return voxels.at(u); }, dims, 16);
    // Level 1 has half of it there, but next to it, inside, no more than a quarter of that.
    EXPECT_GT(errors.of(1 + 4 * (1 + 3 * 1)).levels.errors[0].largest, 0.35) << plane;
    EXPECT_GT(errors.of(1 + 4 * (1 + 3 * 1)).levels.errors[0].sum, 0.35 * 18) << plane;
  }
}

TEST(LevelErrors, CancelWhereFieldsAreRough)
{
  const glm::i64vec3 dims(48, 48, 48);
  const Field field = RoughField(dims);
  const inr::LineErrors lines = Measured(field, dims, 16).of(1 + 3 * (1 + 3 * 1)).levels.errors[0];
  EXPECT_GT(lines.largest, 0.4);
  EXPECT_LT(lines.sum, 0.4 * 18 * std::sqrt(3.0) * lines.largest);
  EXPECT_GT(lines.magnitude, 1.3 * lines.sum);
}

TEST(LevelErrors, AreTheSameByAnyKernel)
{
  const glm::i64vec3 dims(45, 34, 27);
  const Field field = RoughField(dims);
  const inr::LevelErrors plain = Measured(field, dims, 11, "baseline");
  for (const inr::InstructionSet set : {inr::InstructionSet::Avx2, inr::InstructionSet::Avx512}) {
    if (!inr::IsUsable(set)) {
      continue;
    }
    const inr::LevelErrors errors = Measured(field, dims, 11, inr::InstructionSetName(set));
    for (std::int64_t cell = 0; cell < 5 * 4 * 3; ++cell) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (const auto& [a, b] :
             {std::pair(errors.of(cell).levels.errors[k], plain.of(cell).levels.errors[k]),
              std::pair(errors.of(cell).steps.errors[k], plain.of(cell).steps.errors[k])}) {
          EXPECT_EQ(a.sum, b.sum);
          EXPECT_EQ(a.magnitude, b.magnitude);
          EXPECT_EQ(a.largest, b.largest);
        }
      }
    }
  }
}

/// In whatever order and detail somebody asks.
TEST(LevelErrors, AreMeasuredAsFarAsAskedFor)
{
  const glm::i64vec3 dims(64, 40, 40);
  const auto field = [](const glm::vec3& u) { // smooth at one end, rough at the other
    return 0.5f + 0.4f * u.x * std::sin(200.0f * u.x * u.x + 90.0f * u.y * u.x);
  };
  const inr::LevelErrors everything = Measured(field, dims, 16);
  const inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  inr::LevelErrors errors(dims, cells.dims, cells.spacing);
  const std::int64_t count = cells.dims.x * cells.dims.y * cells.dims.z;
  const FieldEvaluator evaluator(field);
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::InstructionSet::Baseline);
  int looks = 0; // at a cell's levels or steps of one power
  const auto measure = [&](const inr::LevelErrors::Question& question) {
    looks = 0;
    std::int64_t points = 0;
    for (std::int64_t block = 0; block < errors.blocks(); ++block) {
      points += errors.measure(block, evaluator, kernel, question, [&] { ++looks; });
    }
    for (std::int64_t cell = 0; cell < count; ++cell) {
      EXPECT_TRUE(errors.knows(cell, question)) << cell;
    }
    return points;
  };
  const auto asIf = [&](inr::LevelErrors::Powers inr::LevelErrors::Cell::*which, int wanted,
                        float limit) {
    for (std::int64_t cell = 0; cell < count; ++cell) {
      const inr::LevelErrors::Powers& all = everything.of(cell).*which;
      const inr::LevelErrors::Powers& powers = errors.of(cell).*which;
      int within = 0;
      while (within < wanted && all.errors[static_cast<std::size_t>(within)].largest <= limit) {
        ++within;
      }
      EXPECT_EQ(powers.known, within) << cell;
      for (std::size_t k = 0; k < static_cast<std::size_t>(within); ++k) {
        EXPECT_EQ(powers.errors[k].sum, all.errors[k].sum) << cell;
        EXPECT_EQ(powers.errors[k].magnitude, all.errors[k].magnitude) << cell;
        EXPECT_EQ(powers.errors[k].largest, all.errors[k].largest) << cell;
      }
    }
  };
  std::int64_t before = 0;
  for (const float limit : {0.01f, 0.1f, 0.3f}) {
    const inr::LevelErrors::Question question{
        3, 2, [&](std::int64_t, const inr::LineErrors& lines) { return lines.largest > limit; }};
    EXPECT_FALSE(errors.knows(0, question));
    const std::int64_t points = measure(question);
    EXPECT_GT(points, before);
    EXPECT_EQ(measure(question), 0); // all is known
    asIf(&inr::LevelErrors::Cell::levels, 3, limit);
    asIf(&inr::LevelErrors::Cell::steps, 2, limit);
  }
  int left = 0;
  for (std::int64_t cell = 0; cell < count; ++cell) {
    left += 6 - errors.of(cell).levels.known - errors.of(cell).steps.known;
  }
  EXPECT_GT(left, 0);
  measure(Everything);
  EXPECT_EQ(looks, left); // at nothing twice
  asIf(&inr::LevelErrors::Cell::steps, 3, 1.0f);
  errors.forget(0);
  EXPECT_FALSE(errors.knows(0, Everything));
}

TEST(LevelErrors, AskNothingAboutCellsThatNobodyWantsToKnow)
{
  const glm::i64vec3 dims(64, 32, 32);
  const inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  inr::LevelErrors errors(dims, cells.dims, cells.spacing);
  const FieldEvaluator evaluator([](const glm::vec3& u) { return u.x; });
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::InstructionSet::Baseline);
  const inr::LevelErrors::Question nothing{
      3, 3, [](std::int64_t, const inr::LineErrors&) { return true; }};
  EXPECT_TRUE(errors.knows(0, nothing));
  EXPECT_EQ(errors.measure(0, evaluator, kernel, nothing, [] {}), 0);
  const inr::LevelErrors::Question one{
      1, 1, [](std::int64_t cell, const inr::LineErrors&) { return cell != 5; }};
  // Voxels 15 to 32, one on either side that a sample is taken for, and two and four that level 1
  // is made of.
  const std::int64_t points = errors.measure(0, evaluator, kernel, one, [] {});
  EXPECT_GE(points, 20 * 18 * 17);
  EXPECT_LE(points, 26 * 24 * 22);
  EXPECT_EQ(errors.of(5).levels.known, 1);
  EXPECT_EQ(errors.of(4).levels.known, 0);
}

TEST(LevelErrors, StayAsTheyAreWhenMeasuringIsStopped)
{
  const glm::i64vec3 dims(32, 32, 32);
  const inr::MacroCells cells = inr::MakeMacroCells(dims, 8);
  inr::LevelErrors errors(dims, cells.dims, cells.spacing);
  const FieldEvaluator evaluator([](const glm::vec3& u) { return u.x; });
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::InstructionSet::Baseline);
  int asked = 0;
  EXPECT_THROW(errors.measure(0, evaluator, kernel, Everything,
                              [&] {
                                if (++asked == 70) {
                                  throw std::runtime_error("stop");
                                }
                              }),
               std::runtime_error);
  EXPECT_EQ(errors.measuredBlocks(), 0);
  EXPECT_FALSE(errors.knows(0, Everything));
  errors.measure(0, evaluator, kernel, Everything, [] {});
  EXPECT_EQ(errors.measuredBlocks(), 1);
  EXPECT_TRUE(errors.knows(63, Everything));
}

TEST(LevelErrors, AreThoseOfAThinFeature)
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
  const double off = 0.8 * (1 - 9.0 / 64);
  EXPECT_NEAR(errors.of(cell(1, 1)).levels.errors[0].largest, 0.8 * (1 - 3.0 / 64), 1e-5);
  EXPECT_NEAR(errors.of(cell(1, 1)).levels.errors[0].sum, 18 * off,
              0.05 * 18 * off);                                    // along the wire
  EXPECT_LT(errors.of(cell(2, 0)).levels.errors[0].largest, 1e-6); // out of reach
  EXPECT_GT(errors.of(cell(1, 1)).levels.errors[2].largest, 0.75);
}

} // namespace test::level_errors
