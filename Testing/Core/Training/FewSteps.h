// SPDX-License-Identifier: BSD-3-Clause
//
// Small steps of a device, and of the CPU beside it.
#pragma once

#include "Core/Training/Descent/AcceleratedDescent.h"
#include "Testing/Core/Training/FakeTrainer.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

/// Mini-batches of a few samples, all different.
class FewBatches : public inr::BatchSource
{
public:
  std::int64_t count() const override { return 32; }
  std::int64_t total() const override { return 32; }
  void prepare(const inr::TrainingStep& step, const inr::StopCheck& check) override
  {
    this->Prepared = step.number;
    check.goesOn();
  }
  void draw(std::uint64_t stream, std::uint64_t step, std::int64_t begin, std::int64_t end,
            glm::vec3* positions, float* targets) const override
  {
    EXPECT_EQ(step, this->Prepared);
    for (std::int64_t k = begin; k < end; ++k) {
      const std::uint64_t number = step * 32 + static_cast<std::uint64_t>(k);
      positions[k - begin] = inr::RandomPosition(stream, number, {9, 9, 9});
      targets[k - begin] = positions[k - begin].x;
    }
  }

private:
  std::uint64_t Prepared = 0;
};

/// Steps of such, by a device and by the CPU beside it.
struct FewSteps
{
  explicit FewSteps(FakeTrainingDevice& fake)
      : Device(fake), Threads(1), Host(TinyDescription(), 1, set(), this->Threads),
        Expected(TinyDescription(), 1, set(), this->Threads),
        Descent(
            this->Host,
            FakeTrainer(fake).start({TinyDescription(), 32, this->Host.stream(), std::nullopt}),
            this->Threads, [this](const std::string& text) { this->Told.push_back(text); },
            [&fake] { return fake.seconds; })
  {
    fake.planned = 2000;
    this->Descent.plan(2000);
    this->Expected.plan(2000);
  }

  static inr::InstructionSet set() { return inr::ChooseInstructionSet(""); }

  void take(std::uint64_t steps)
  {
    while (this->Descent.steps() < steps) {
      this->Descent.step(this->Batches);
    }
  }
  void expect(std::uint64_t steps)
  {
    EXPECT_EQ(this->Descent.steps(), steps);
    FewBatches batches;
    while (this->Expected.steps() < steps) {
      this->Expected.step(batches);
    }
    EXPECT_EQ(this->Descent.parameters(), this->Expected.parameters());
  }

  FakeTrainingDevice& Device;
  inr::Arena Threads;
  inr::GradientDescent Host;
  inr::GradientDescent Expected;
  FewBatches Batches;
  std::vector<std::string> Told;
  inr::AcceleratedDescent Descent;
};
