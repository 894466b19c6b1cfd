// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Tolerance/LongLines.h"

#include "Core/GridBox.h"

#include <algorithm>

namespace inr {

namespace {

/// Voxels: the smallest macro-cell that is made by default, and what is seen on either side. In
/// cells of 64 and 128, 320 pictures of test_random_tolerances were off by up to 1.8 of their
/// tolerance without parts, and by 0.33 with parts of 9, 18 or 36, for 64, 87, 83 and 77 % of the
/// samples.
constexpr std::int64_t LongestPart = 18;

/// The largest sum on a way from box to box that goes up along x, and up or down along the others.
float LargestOnWays(const std::vector<float>& numbers, const glm::i64vec3& count, bool upY,
                    bool upZ)
{
  const glm::i64vec3 stride(1, upY ? count.x : -count.x,
                            upZ ? count.x * count.y : -count.x * count.y);
  const std::int64_t first =
      (upY ? 0 : (count.y - 1) * count.x) + (upZ ? 0 : (count.z - 1) * count.x * count.y);
  std::vector<float> sums(numbers.size());
  float largest = 0;
  for (std::int64_t z = 0; z < count.z; ++z) {
    for (std::int64_t y = 0; y < count.y; ++y) {
      for (std::int64_t x = 0; x < count.x; ++x) {
        const std::int64_t at = first + x + y * stride.y + z * stride.z;
        const auto before = [&](std::int64_t place, std::int64_t step) {
          return place > 0 ? sums[static_cast<std::size_t>(at - step)] : 0.0f;
        };
        float& sum = sums[static_cast<std::size_t>(at)];
        sum = numbers[static_cast<std::size_t>(at)] +
              std::max(before(x, stride.x), std::max(before(y, stride.y), before(z, stride.z)));
        largest = std::max(largest, sum);
      }
    }
  }
  return largest;
}

} // namespace

float LargestAlongLines(const std::vector<float>& numbers, const glm::i64vec3& count)
{
  float largest = 0;
  for (const bool upY : {false, true}) {
    for (const bool upZ : {false, true}) {
      largest = std::max(largest, LargestOnWays(numbers, count, upY, upZ));
    }
  }
  return largest;
}

LineErrors FindLongLineErrors(const ValueBox& fine, const ValueBox& taken, const GridBox& whole,
                              int power, const LineKernel& kernel, const IsTooLarge& isTooLarge)
{
  const glm::i64vec3 count = (whole.size + LongestPart - std::int64_t{1}) / LongestPart;
  std::vector<float> sums;
  std::vector<float> magnitudes;
  LineErrors errors;
  for (std::int64_t k = 0; k < GridCount(count); ++k) {
    const glm::i64vec3 at = GridPlace(k, count);
    const glm::i64vec3 begin = at * whole.size / count;
    const glm::i64vec3 end = (at + std::int64_t{1}) * whole.size / count;
    const LineErrors found =
        FindLineErrors(fine, taken, {whole.first + begin, end - begin}, power, kernel, isTooLarge);
    if (isTooLarge(found)) {
      return found;
    }
    errors.largest = std::max(errors.largest, found.largest);
    sums.push_back(found.sum);
    magnitudes.push_back(found.magnitude);
  }
  errors.sum = LargestAlongLines(sums, count);
  errors.magnitude = LargestAlongLines(magnitudes, count);
  return errors;
}

} // namespace inr
