// SPDX-License-Identifier: BSD-3-Clause
//
// The updates of every kernel against the formulas of Kingma and Ba in float64.
#include "Core/Random.h"
#include "Core/Training/TrainKernel.h"
#include "Testing/Core/Kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

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
      this->updates[k] = static_cast<std::uint16_t>(k % 5);
    }
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
            0.999f,
            static_cast<float>(Epsilon),
            decay};
  }

  std::vector<float> parameters, gradients, first, second;
  std::vector<std::uint16_t> updates;
  std::vector<std::uint8_t> touched;
};

void ExpectUpdated(const State& before, const State& after, std::size_t k, double rate,
                   double decay)
{
  const double gradient = before.gradients[k] + decay * before.parameters[k];
  const double first = 0.9 * before.first[k] + 0.1 * gradient;
  const double second = 0.999 * before.second[k] + 0.001 * gradient * gradient;
  EXPECT_NEAR(after.first[k], first, 1e-6) << k;
  EXPECT_NEAR(after.second[k], second, 1e-6) << k;
  EXPECT_NEAR(after.parameters[k],
              before.parameters[k] - rate * first / (std::sqrt(second) + Epsilon), 1e-5)
      << k;
}

TEST(Adam, UpdatesAll)
{
  for (const std::string& kernel : UsableKernels()) {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(kernel));
    for (const std::int64_t count : {1, 7, 16, 45}) {
      const State before(count);
      State after = before;
      train.adam(after.run(0.25f), count, Rate);
      for (std::size_t k = 0; k < after.parameters.size(); ++k) {
        ExpectUpdated(before, after, k, Rate, 0.25);
      }
    }
  }
}

TEST(Adam, UpdatesWhatWasTouchedAndHasAGradient)
{
  const std::vector<float> corrections = {9.0f, 2.0f, 1.5f, 1.25f, 1.125f};
  for (const std::string& kernel : UsableKernels()) {
    const inr::TrainKernel& train = inr::TrainKernelFor(inr::ChooseInstructionSet(kernel));
    for (const std::int64_t count : {2, 8, 27, 160}) {
      State before(count);
      for (std::size_t k = 0; k < before.gradients.size(); ++k) {
        const std::size_t line = k / static_cast<std::size_t>(inr::GradientLine);
        before.touched[line] = line % 3 == 0 ? 1 : 0;
        const bool moves = before.touched[line] != 0 && k % 4 != 1;
        before.gradients[k] = moves ? before.gradients[k] : 0.0f;
      }
      State after = before;
      train.adamSparse(after.run(0.0f), count, after.touched.data(), Rate, after.updates.data(),
                       {corrections.data(), 4});
      for (std::size_t k = 0; k < after.parameters.size(); ++k) {
        if (before.gradients[k] != 0.0f) {
          const int updates = std::min(before.updates[k] + 1, 4);
          EXPECT_EQ(after.updates[k], updates);
          ExpectUpdated(before, after, k, Rate * corrections[static_cast<std::size_t>(updates)], 0);
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

} // namespace
