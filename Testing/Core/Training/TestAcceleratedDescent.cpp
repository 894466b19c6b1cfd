// SPDX-License-Identifier: BSD-3-Clause
//
// Steps of gradient descent by an accelerator that computes what Core does, one by one: whatever
// happens to it, the parameters are the CPU's, to the last bit.
#include "Core/Error.h"
#include "Core/Training/AcceleratedDescent.h"
#include "Core/Training/BatchSource.h"
#include "Testing/Core/Training/FakeTrainer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

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
        Descent(this->Host,
                FakeTrainer(fake).start({TinyDescription(), 32, this->Host.stream(), std::nullopt}),
                this->Threads, [this](const std::string& text) { this->Told.push_back(text); })
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

/// And takes no more steps again than there are between two copies.
TEST(AcceleratedDescent, KeepsACopyOfLateSteps)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  few.take(470);
  EXPECT_TRUE(few.Descent.isAccelerated());
  EXPECT_EQ(few.Host.steps(), 401u); // the first step, and each 200 from there
  EXPECT_EQ(device.gets, 3);
  device.failsAt = device.calls;
  few.Descent.step(few.Batches);
  EXPECT_FALSE(few.Descent.isAccelerated());
  ASSERT_EQ(few.Told.size(), 1u);
  EXPECT_NE(few.Told[0].find("after 401 steps, and takes 69 steps again"), std::string::npos)
      << few.Told[0];
  few.expect(402);
  few.take(500);
  few.expect(500);
}

TEST(AcceleratedDescent, IsAskedForNothingTwice)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  few.take(10);
  few.expect(10);
  const int calls = device.calls;
  few.Descent.state();
  few.Descent.view();
  few.expect(10);
  EXPECT_EQ(device.calls, calls);
}

/// Another state, which was put where state() said.
TEST(AcceleratedDescent, GoesOnFromWhateverIsPutThere)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  few.take(4);
  const std::vector<float> values = few.Descent.parameters();
  std::vector<std::vector<char>> before;
  for (const inr::StateArray& array : few.Descent.state()) {
    const auto* from = static_cast<const char*>(array.data);
    before.emplace_back(from, from + array.bytes);
  }
  few.take(9);
  const inr::StateArrays arrays = few.Descent.state();
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    std::copy(before[k].begin(), before[k].end(), static_cast<char*>(arrays[k].data));
  }
  few.Descent.goOnAfter(4);
  EXPECT_EQ(few.Descent.parameters(), values);
  few.take(7);
  few.expect(7);
}

/// Whenever it is stopped, a step that is repeated gives what it would have given.
TEST(AcceleratedDescent, AStoppedStepChangesNothing)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  int stops = 0;
  for (int limit = 1; few.Descent.steps() < 8; limit = limit % 40 + 3) {
    int asked = 0;
    const inr::StopCheck check([&] { return ++asked < limit; });
    const std::uint64_t before = few.Descent.steps();
    const bool taken = few.Descent.step(few.Batches, check).has_value();
    EXPECT_EQ(few.Descent.steps(), before + (taken ? 1 : 0));
    stops += taken ? 0 : 1;
  }
  EXPECT_GT(stops, 3);
  few.expect(8);
}

/// What throws while the device is at work does not take its step away.
TEST(AcceleratedDescent, AStepThatHasBegunCounts)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  few.take(3);
  int asked = 0;
  const inr::StopCheck check([&]() -> bool {
    if (++asked > 1) { // while the next samples are drawn
      throw inr::Error(inr::ErrorCode::Cancelled, "stopped");
    }
    return true;
  });
  EXPECT_THROW(few.Descent.step(few.Batches, check), inr::Error);
  few.expect(4);
  few.take(6);
  few.expect(6);
}

/// A plan that comes later than samples were drawn, for these may depend on it.
TEST(AcceleratedDescent, DrawsAgainForAnotherPlan)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  few.take(3);
  few.Descent.plan(2000);
  few.take(4);
  few.expect(4);
}

} // namespace
