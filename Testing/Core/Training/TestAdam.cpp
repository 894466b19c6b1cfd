// SPDX-License-Identifier: BSD-3-Clause
//
// The updates of every kernel against the formulas of Kingma and Ba in float64.
#include "Core/Random.h"
#include "Core/Training/Descent/AdamSchedule.h"
#include "Testing/Core/Kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace test::adam {

constexpr float Rate = 0.01f;
constexpr double Epsilon = 1e-15;

/// Parameters in training, with what belongs to each.
struct State
{
  explicit State(std::int64_t count)
      : parameters(Random(1, count)), gradients(Random(2, count)), first(Random(3, count)),
        second(Random(4, count)), updates(static_cast<std::size_t>(count)),
        touched(static_cast<std::size_t>(count + inr::GradientLine - 1) / inr::GradientLine)
  {
    for (std::size_t k = 0; k < this->second.size(); ++k) {
      this->second[k] *= this->second[k];
      this->updates[k] = UpdatesBefore(k);
    }
  }

  /// At first each has another number of them, then sixteen the same, then but for one in between.
  static std::uint16_t UpdatesBefore(std::size_t k)
  {
    if (k < 64) {
      return static_cast<std::uint16_t>(k % 5);
    }
    return static_cast<std::uint16_t>(k >= 256 && k % 8 == 5 ? 1 : k / 16 % 5);
  }

  static std::vector<float> Random(std::uint64_t seed, std::int64_t count)
  {
    std::vector<float> values;
    for (std::int64_t k = 0; k < count; ++k) {
      values.push_back(inr::RandomUnit(seed, static_cast<std::uint64_t>(k)) - 0.5f);
    }
    return values;
  }

  inr::AdamRun run(float decay)
  {
    return {this->parameters.data(),
            this->gradients.data(),
            this->first.data(),
            this->second.data(),
            0.9f,
            static_cast<float>(Epsilon),
            decay};
  }

  std::vector<float> parameters, gradients, first, second;
  std::vector<std::uint16_t> updates;
  std::vector<std::uint8_t> touched;
};

void ExpectUpdated(const State& before, const State& after, std::size_t k,
                   const inr::AdamStep& step, double decay)
{
  const double kept = step.beta2;
  const double gradient = before.gradients[k] + decay * before.parameters[k];
  const double first = 0.9 * before.first[k] + 0.1 * gradient;
  const double second = kept * before.second[k] + (1 - kept) * gradient * gradient;
  EXPECT_NEAR(after.first[k], first, 1e-6) << k;
  EXPECT_NEAR(after.second[k], second, 1e-6) << k;
  EXPECT_NEAR(after.parameters[k],
              before.parameters[k] - step.rate * first / (std::sqrt(second) + Epsilon), 1e-5)
      << k;
}

TEST(Adam, UpdatesAll)
{
  for (const std::string& kernel : UsableKernels()) {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(kernel));
    for (const std::int64_t count : {1, 7, 16, 45}) {
      const State before(count);
      State after = before;
      const inr::AdamStep step{Rate, 0.95f};
      train.adam(after.run(0.25f), count, step);
      for (std::size_t k = 0; k < after.parameters.size(); ++k) {
        ExpectUpdated(before, after, k, step, 0.25);
      }
    }
  }
}

TEST(Adam, UpdatesWhatWasTouchedAndHasAGradient)
{
  const std::vector<inr::AdamStep> steps = {
      {9.0f, 0.1f}, {2.0f, 0.5f}, {1.5f, 0.8f}, {1.25f, 0.9f}, {1.125f, 0.999f}};
  for (const std::string& kernel : UsableKernels()) {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(kernel));
    for (const std::int64_t count : {2, 8, 27, 160, 4396}) {
      State before(count);
      for (std::size_t k = 0; k < before.gradients.size(); ++k) {
        const std::size_t line = k / static_cast<std::size_t>(inr::GradientLine);
        before.touched[line] = line % 3 == 0 || line / 8 % 2 == 1 ? 1 + line % 2 : 0;
        const bool moves = before.touched[line] != 0 && (k % 4 != 1 || k > 96);
        before.gradients[k] = moves ? before.gradients[k] : 0.0f;
      }
      State after = before;
      train.adamSparse(after.run(0.0f), count, after.touched.data(), Rate, after.updates.data(),
                       {steps.data(), 4});
      for (std::size_t k = 0; k < after.parameters.size(); ++k) {
        if (before.gradients[k] != 0.0f) {
          const int updates = std::min(before.updates[k] + 1, 4);
          EXPECT_EQ(after.updates[k], updates);
          inr::AdamStep step = steps[static_cast<std::size_t>(updates)];
          step.rate *= Rate;
          ExpectUpdated(before, after, k, step, 0);
        } else {
          EXPECT_EQ(after.parameters[k], before.parameters[k]);
          EXPECT_EQ(after.first[k], before.first[k]);
          EXPECT_EQ(after.second[k], before.second[k]);
          EXPECT_EQ(after.updates[k], before.updates[k]);
        }
        EXPECT_EQ(after.gradients[k], 0.0f);
      }
      EXPECT_EQ(after.touched, std::vector<std::uint8_t>(after.touched.size(), 0));
    }
  }
}

TEST(Adam, GoesAsFarAsTheLearningRateWhereTheGradientStays)
{
  constexpr double gradient = 0.25;
  double first = 0;
  double second = 0;
  const std::vector<inr::AdamStep> steps = inr::AdamUpdates();
  ASSERT_EQ(steps.size(), inr::LastAdamUpdate + 1);
  for (std::size_t t = 1; t < steps.size(); ++t) {
    first = inr::FirstMomentKept * first + (1 - inr::FirstMomentKept) * gradient;
    const double kept = steps[t].beta2;
    second = kept * second + (1 - kept) * gradient * gradient;
    EXPECT_NEAR(steps[t].rate * first / std::sqrt(second), 1.0, 1e-5) << t;
  }
}

TEST(Adam, RemembersATenthOfTheUpdates)
{
  const std::vector<inr::AdamStep> steps = inr::AdamUpdates();
  EXPECT_FLOAT_EQ(steps[1].beta2, 0.99f);
  EXPECT_FLOAT_EQ(steps[1000].beta2, 0.99f);
  EXPECT_FLOAT_EQ(steps[4000].beta2, 0.9975f);
  EXPECT_FLOAT_EQ(steps[10000].beta2, 0.999f);
  EXPECT_FLOAT_EQ(steps[inr::LastAdamUpdate].beta2, 0.999f);
}

} // namespace test::adam
