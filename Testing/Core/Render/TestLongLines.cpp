// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Random.h"
#include "Core/Render/Tolerance/LongLines.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace test::long_lines {

bool Never(const inr::LineErrors&) { return false; }

/// The sum of the boxes that a line meets, looked at in small steps.
float SumAlong(const std::vector<float>& numbers, const glm::i64vec3& count, const glm::dvec3& from,
               const glm::dvec3& to)
{
  std::int64_t last = -1;
  float sum = 0;
  constexpr int steps = 1000;
  for (int k = 0; k <= steps; ++k) {
    const glm::dvec3 place = from + (to - from) * (static_cast<double>(k) / steps);
    const glm::i64vec3 box(glm::min(glm::floor(place), glm::dvec3(count) - 1.0));
    const std::int64_t number = box.x + count.x * (box.y + count.y * box.z);
    if (number != last) {
      sum += numbers[static_cast<std::size_t>(number)];
    }
    last = number;
  }
  return sum;
}

TEST(LongLines, HaveNoMoreThanTheLargestWay)
{
  for (const glm::i64vec3& count :
       {glm::i64vec3(1, 1, 1), glm::i64vec3(4, 3, 5), glm::i64vec3(6, 1, 2)}) {
    std::uint64_t random = 0;
    std::vector<float> numbers;
    for (std::int64_t k = 0; k < count.x * count.y * count.z; ++k) {
      const double number = inr::RandomUnit(3, random++);
      numbers.push_back(static_cast<float>(number * number * number)); // few are large
    }
    const float most = inr::LargestAlongLines(numbers, count);
    float met = 0;
    for (int line = 0; line < 2000; ++line) {
      glm::dvec3 ends[2];
      for (glm::dvec3& end : ends) {
        for (int axis = 0; axis < 3; ++axis) {
          end[axis] = inr::RandomUnit(3, random++) * static_cast<double>(count[axis]);
        }
      }
      met = std::max(met, SumAlong(numbers, count, ends[0], ends[1]));
    }
    EXPECT_LE(met, most * (1 + 1e-6));
    EXPECT_GE(met, 0.6f * most); // nor far more than there is
  }
}

TEST(LongLines, GoEachWayThatIsUpOrDownAlongAnAxis)
{
  const glm::i64vec3 count(3, 3, 3);
  for (const glm::i64vec3& begin : {glm::i64vec3(0, 0, 0), glm::i64vec3(0, 0, 2),
                                    glm::i64vec3(0, 2, 0), glm::i64vec3(0, 2, 2)}) {
    std::vector<float> numbers(27, 0.0f);
    const auto at = [&](const glm::i64vec3& box) -> float& {
      return numbers[static_cast<std::size_t>(box.x + 3 * (box.y + 3 * box.z))];
    };
    at(begin) = at({1, 1, 1}) = at(glm::i64vec3(2) - begin) = 1; // a diagonal
    EXPECT_EQ(inr::LargestAlongLines(numbers, count), 3) << begin.y << begin.z;
    at({begin.x, 2 - begin.y, begin.z}) = 1; // none goes there, too
    EXPECT_EQ(inr::LargestAlongLines(numbers, count), 3) << begin.y << begin.z;
  }
}

/// As LineErrors says of all of a box where nothing is cut into parts.
TEST(LongLines, AreCutAndPutTogether)
{
  const glm::i64vec3 size(50, 9, 20);
  const inr::ValueBox fine(size);
  inr::ValueBox taken(size);
  for (std::int64_t x = 0; x < size.x; ++x) { // a row, and a value apart from it
    taken.values[taken.index(x, 4, 10)] = 0.25f;
  }
  taken.values[taken.index(30, 0, 0)] = 1.0f;
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::InstructionSet::Baseline);
  const inr::GridBox all{{0, 0, 0}, size};
  const inr::LineErrors whole = inr::FindLineErrors(fine, taken, all, 1, kernel, Never);
  const inr::LineErrors parts = inr::FindLongLineErrors(fine, taken, all, 1, kernel, Never);
  EXPECT_GE(parts.sum, whole.sum * (1 - 1e-6));
  EXPECT_LE(parts.sum, 1.1f * whole.sum);
  EXPECT_GE(parts.magnitude, whole.magnitude * (1 - 1e-6));
  EXPECT_EQ(parts.largest, whole.largest);
}

/// A fibre between all directions that are looked at is met in each part, not once in all of the
/// box.
TEST(LongLines, SeeMoreOfWhatIsBetweenTheirDirections)
{
  const glm::i64vec3 size(90, 60, 30);
  const inr::ValueBox fine(size);
  inr::ValueBox taken(size);
  const glm::dvec3 way = glm::normalize(glm::dvec3(3, 2, 1));
  for (std::int64_t k = 0; k < taken.count(); ++k) {
    const glm::i64vec3 at = inr::GridPlace(k, size);
    const double distance = glm::length(glm::cross(way, glm::dvec3(at)));
    taken.values[static_cast<std::size_t>(k)] =
        static_cast<float>(std::exp(-distance * distance / 1.44));
  }
  const double along = glm::length(glm::dvec3(size)); // the sum on the fibre's axis
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::ChooseInstructionSet({}));
  const inr::GridBox all{{0, 0, 0}, size};
  EXPECT_LT(inr::FindLineErrors(fine, taken, all, 1, kernel, Never).sum, 0.15 * along);
  EXPECT_GE(inr::FindLongLineErrors(fine, taken, all, 1, kernel, Never).sum, 0.4 * along);
}

TEST(LongLines, EndWithTheFirstPartThatIsTooLarge)
{
  const glm::i64vec3 size(90, 4, 4);
  const inr::ValueBox fine(size);
  inr::ValueBox taken(size);
  std::fill(taken.values.begin(), taken.values.end(), 1.0f);
  const inr::LineKernel& kernel = inr::LineKernelFor(inr::InstructionSet::Baseline);
  int asked = 0;
  const auto tooLarge = [&](const inr::LineErrors& errors) {
    ++asked;
    return errors.sum > 2;
  };
  const inr::LineErrors errors =
      inr::FindLongLineErrors(fine, taken, {{0, 0, 0}, size}, 1, kernel, tooLarge);
  EXPECT_GT(errors.sum, 2);
  EXPECT_LT(errors.sum, 19); // of five parts
  EXPECT_LE(asked, 2);       // where it is found, and where parts are put together
}

} // namespace test::long_lines
