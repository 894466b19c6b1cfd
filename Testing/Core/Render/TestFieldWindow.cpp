// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Model/Model.h"
#include "Core/Render/Tolerance/FieldWindow.h"
#include "Testing/Core/RandomModel.h"

#include <gtest/gtest.h>

namespace test::field_window {

/// Counts the points that it is asked for.
class Counting : public inr::Evaluator
{
public:
  explicit Counting(std::shared_ptr<const inr::Evaluator> field) : Field(std::move(field)) {}
  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    this->Field->evaluate(positions, count, values);
    this->Points += count;
  }
  void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const override
  {
    this->Field->evaluateGrid(axes, values);
    this->Points += static_cast<std::int64_t>(axes[0].size() * axes[1].size() * axes[2].size());
  }
  std::string kernel() const override { return this->Field->kernel(); }
  std::int64_t points() const { return this->Points; }

private:
  std::shared_ptr<const inr::Evaluator> Field;
  mutable std::int64_t Points = 0;
};

/// However a window came to hold them, voxels have the same values, each asked for once.
TEST(FieldWindow, GrowsWithoutAskingTwice)
{
  const glm::i64vec3 dims(60, 50, 40);
  inr::Description description;
  const Counting network(inr::MakeEvaluator(RandomModel(description)));
  inr::FieldWindow grown(network, dims);
  EXPECT_EQ(grown.points(), 0);
  const inr::VoxelSpan steps[][3] = {{{20, 29}, {30, 41}, {10, 10}},
                                     {{20, 29}, {30, 41}, {10, 10}},
                                     {{22, 24}, {31, 32}, {10, 10}}, // all held
                                     {{18, 35}, {30, 40}, {7, 12}},
                                     {{19, 20}, {12, 49}, {11, 39}}};
  for (const auto& step : steps) {
    grown.extendTo(step);
  }
  EXPECT_EQ(grown.points(), 18 * 38 * 33);
  EXPECT_EQ(network.points(), grown.points());

  inr::FieldWindow whole(network, dims);
  const inr::VoxelSpan all[3] = {{0, 59}, {0, 49}, {0, 39}};
  whole.extendTo(all);
  const inr::VoxelSpan held[3] = {{18, 35}, {12, 49}, {7, 39}};
  EXPECT_EQ(grown.cut(held).values, whole.cut(held).values);
  const inr::VoxelSpan part[3] = {{21, 21}, {31, 44}, {8, 38}};
  const inr::ValueBox box = whole.cut(part);
  EXPECT_EQ(box.size, glm::i64vec3(1, 14, 31));
  EXPECT_EQ(grown.cut(part).values, box.values);
  const glm::vec3 place((glm::vec3(21, 40, 20) + 0.5f) / glm::vec3(dims));
  float value = 0;
  network.evaluate(&place, 1, &value);
  EXPECT_NEAR(box.values[box.index(0, 40 - 31, 20 - 8)], inr::NormalisedOutput(value), 1e-4);
}

} // namespace test::field_window
