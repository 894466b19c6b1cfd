// SPDX-License-Identifier: BSD-3-Clause
//
// Lattices of few points along an axis: kernels put rows of several layers together, and only those
// points of a row that are wanted.
#include "Core/Inference/Evaluator.h"
#include "Testing/Core/Inference/OddShapes.h"
#include "Testing/Core/Inference/RoundingKernels.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace test::thin_lattices {

constexpr std::size_t First = 2; ///< of the wide lattice's points, the first of the thin ones
constexpr std::size_t Width = 11;

/// Values of all points along x of `axes`, or of `count` of them.
std::vector<float> ValuesOf(const inr::Evaluator& evaluator, const std::vector<float> (&axes)[3],
                            std::size_t count)
{
  const auto begin = axes[0].begin() + (count == Width ? 0 : First);
  const std::vector<float> part[3] = {
      {begin, begin + static_cast<std::ptrdiff_t>(count)}, axes[1], axes[2]};
  std::vector<float> values(count * axes[1].size() * axes[2].size());
  evaluator.evaluateGrid(part, values.data());
  return values;
}

void ExpectPartsOfWideOnes(const inr::Evaluator& evaluator, std::size_t height, std::size_t depth)
{
  std::vector<float> axes[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t count = axis == 0 ? Width : axis == 1 ? height : depth;
    for (std::size_t k = 0; k < count; ++k) {
      axes[axis].push_back((static_cast<float>(k) + 0.3f) / static_cast<float>(count));
    }
  }
  const std::vector<float> whole = ValuesOf(evaluator, axes, Width);
  for (const std::size_t count : {1, 2, 3, 5, 7, 8, 9}) {
    const std::vector<float> values = ValuesOf(evaluator, axes, count);
    for (std::size_t k = 0; k < values.size(); ++k) {
      ASSERT_EQ(values[k], whole[k / count * Width + First + k % count])
          << evaluator.kernel() << ", " << count << " along x, value " << k;
    }
  }
}

TEST(ThinLattices, ArePartsOfWideOnes)
{
  const RoundingKernels rounding;
  for (const inr::Description& description : OddShapes()) {
    SCOPED_TRACE(testing::Message() << description.network.neurons << " neurons, "
                                    << description.grid.features << " features");
    for (const inr::InferenceKernels& kernels : AllKernels(rounding)) {
      const auto evaluator = inr::MakeEvaluator(CalmModel(description), kernels);
      ExpectPartsOfWideOnes(*evaluator, 1, 3);
      ExpectPartsOfWideOnes(*evaluator, 7, 2);
    }
  }
}

/// With one point a row, more rows than any strip has.
TEST(ThinLattices, FillSeveralStrips)
{
  const RoundingKernels rounding;
  for (const inr::InferenceKernels& kernels : AllKernels(rounding)) {
    ExpectPartsOfWideOnes(*inr::MakeEvaluator(CalmModel(SmallDescription()), kernels), 75, 1);
  }
}

/// A kernel would read the coordinate before the first, which only a sanitizer sees.
TEST(ThinLattices, MayHaveNoPoints)
{
  const auto evaluator = inr::MakeEvaluator(RandomModel(SmallDescription()));
  for (int empty = 0; empty < 3; ++empty) {
    std::vector<float> axes[3] = {{0.5f}, {0.5f}, {0.5f}};
    axes[empty].clear();
    float value = 7;
    evaluator->evaluateGrid(axes, &value);
    EXPECT_EQ(value, 7.0f);
  }
}

} // namespace test::thin_lattices
