// SPDX-License-Identifier: BSD-3-Clause
//
// Errors along lines against sums that are taken line by line, from every voxel on.
#include "Core/Random.h"
#include "Core/Render/Tolerance/LineErrors.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::line_errors {

bool Never(const inr::LineErrors&) { return false; }

inr::ValueBox RandomBox(const glm::i64vec3& size, std::uint64_t seed)
{
  inr::ValueBox box(size);
  for (std::size_t k = 0; k < box.values.size(); ++k) {
    box.values[k] = static_cast<float>(inr::RandomUnit(seed, k));
  }
  return box;
}

/// What FindLineErrors looks at.
struct Lines
{
  const inr::ValueBox& fine;
  const inr::ValueBox& taken;
  inr::GridBox part;
  int power;

  static bool isIn(const glm::i64vec3& at, const glm::i64vec3& size)
  {
    return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
  }
  static float of(const inr::ValueBox& box, const glm::i64vec3& at)
  {
    return box.values[box.index(at.x, at.y, at.z)];
  }

  /// What a sample at voxel `at` of a line, or half-way to the next, gets wrong about all that it
  /// is taken for.
  struct Error
  {
    double sum = 0;
    double magnitude = 0;
    double largest = 0;
  };
  Error error(const glm::i64vec3& at, const glm::i64vec3& way, bool between) const
  {
    const std::int64_t half = this->together(way) / 2;
    const std::int64_t before = between ? half - 1 : half;
    if (!isIn(at - before * way, fine.size) || !isIn(at + half * way, fine.size)) {
      return {};
    }
    const double sample =
        between ? 0.5 * (of(taken, at) + of(taken, at + way)) : double{of(taken, at)};
    Error error;
    for (std::int64_t k = -before; k <= half; ++k) {
      const double here = sample - of(fine, at + k * way);
      const double weight = !between && half > 0 && std::abs(k) == half ? 0.5 : 1.0;
      error.sum += weight * here;
      error.magnitude += weight * std::abs(here);
      error.largest = std::max(error.largest, std::abs(here));
    }
    return error;
  }
  std::int64_t together(const glm::i64vec3& way) const
  {
    const bool diagonal = way.x * way.x + way.y * way.y + way.z * way.z > 1;
    return (std::int64_t{1} << power) / (diagonal ? 2 : 1);
  }

  /// Of all parts of the line of samples from `at` on that begin there.
  void addTo(inr::LineErrors& errors, glm::i64vec3 at, const glm::i64vec3& way, bool between) const
  {
    const auto length = static_cast<float>(glm::length(glm::dvec3(way)));
    double sum = 0;
    double magnitude = 0;
    for (; isIn(at - part.first, part.size); at += this->together(way) * way) {
      const Error here = this->error(at, way, between);
      sum += here.sum;
      magnitude += here.magnitude;
      errors.sum = std::max(errors.sum, length * static_cast<float>(std::abs(sum)));
      errors.magnitude = std::max(errors.magnitude, length * static_cast<float>(magnitude));
      errors.largest = std::max(errors.largest, static_cast<float>(here.largest));
    }
  }
};

inr::LineErrors LineByLine(const Lines& lines)
{
  inr::LineErrors errors;
  const glm::i64vec3 size = lines.part.size;
  for (int number = 14; number < 27; ++number) {
    const glm::i64vec3 other(number % 3 - 1, number / 3 % 3 - 1, number / 9 - 1);
    const std::int64_t last = other.z != 0 ? other.z : other.y != 0 ? other.y : other.x;
    const glm::i64vec3 way = last * other; // slices are counted upwards
    for (std::int64_t k = 0; k < size.x * size.y * size.z; ++k) {
      const glm::i64vec3 within = inr::GridPlace(k, size);
      lines.addTo(errors, lines.part.first + within, way, false);
      if (lines.together(way) > 1) {
        lines.addTo(errors, lines.part.first + within, way, true);
      }
    }
  }
  return errors;
}

TEST(LineErrors, AreTheLargestOfAllLines)
{
  const glm::i64vec3 size(14, 13, 12);
  const inr::ValueBox fine = RandomBox(size, 1);
  const inr::ValueBox taken = RandomBox(size, 2);
  const inr::GridBox parts[] = {
      {{2, 1, 3}, {9, 10, 7}}, {{0, 0, 0}, size}, {{5, 0, 11}, {3, 13, 1}}};
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::InstructionSet::Baseline);
  for (const inr::GridBox& part : parts) {
    for (const int power : {1, 2, 3}) {
      const Lines lines{fine, taken, part, power};
      const inr::LineErrors expected = LineByLine(lines);
      const inr::LineErrors found = inr::FindLineErrors(fine, taken, part, power, kernel, Never);
      EXPECT_NEAR(found.sum, expected.sum, 2e-5) << power << " " << part.size.z;
      EXPECT_NEAR(found.magnitude, expected.magnitude, 5e-5) << power << " " << part.size.z;
      EXPECT_NEAR(found.largest, expected.largest, 1e-6) << power << " " << part.size.z;
    }
  }
}

/// What goes out of a part does not come in again on its other side.
TEST(LineErrors, EndWhereThePartDoes)
{
  const glm::i64vec3 size(4, 4, 20);
  const inr::ValueBox fine(size);
  inr::ValueBox taken(size);
  std::fill(taken.values.begin(), taken.values.end(), 1.0f);
  const inr::LineErrors errors = inr::FindLineErrors(
      fine, taken, {{0, 0, 0}, size}, 1, inr::LineKernelFor(inr::InstructionSet::Baseline), Never);
  EXPECT_FLOAT_EQ(errors.sum, 20.0f); // along z; a diagonal of four is 7 long
}

} // namespace test::line_errors
