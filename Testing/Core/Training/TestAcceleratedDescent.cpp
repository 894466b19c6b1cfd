// SPDX-License-Identifier: BSD-3-Clause
//
// Steps by a device: whose they are, which of them are safe, and what becomes of the others.
#include "Core/Error.h"
#include "Testing/Core/Training/FewSteps.h"

#include <cmath>
#include <functional>
#include <utility>

namespace test::accelerated_descent {

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

/// Copies that take 3 steps' time are 150 steps apart at least, and those that take 8, 400.
TEST(AcceleratedDescent, CopiesFromTimeToTime)
{
  for (const auto& [copySeconds, copiedAt] : {std::pair{1.5, 401u}, {4.0, 801u}}) {
    FakeTrainingDevice device;
    device.stepSeconds = 0.5;
    device.copySeconds = copySeconds;
    FewSteps few(device);
    few.take(copiedAt - 1);
    EXPECT_EQ(device.gets, 2);
    few.take(copiedAt);
    EXPECT_EQ(few.Host.steps(), copiedAt);
    EXPECT_EQ(device.gets, 3);
  }
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
  const inr::AlignedVector<float> values = few.Descent.parameters();
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

TEST(AcceleratedDescent, BeginsAnewFromOtherParameters)
{
  FakeTrainingDevice device;
  device.planned = 2000;
  FewSteps few(device);
  FewBatches batches;
  few.take(4);
  while (few.Expected.steps() < 4) {
    few.Expected.step(batches);
  }
  few.Descent.startAnew(9);
  few.Expected.startAnew(9);
  EXPECT_EQ(few.Descent.parameters(), few.Expected.parameters());
  few.take(7);
  few.expect(7);
  EXPECT_TRUE(few.Descent.isAccelerated());
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

/// Parameters, moments and counts of updates, as they are now.
std::vector<std::vector<char>> Bytes(inr::Descent& descent)
{
  std::vector<std::vector<char>> bytes;
  for (const inr::StateArray& array : descent.state()) {
    const auto* from = static_cast<const char*>(array.data);
    bytes.emplace_back(from, from + array.bytes);
  }
  return bytes;
}

/// A way in which a device's first step is not the CPU's.
struct Fault
{
  const char* name;
  std::function<void(FakeTrainingDevice&)> bring;
};

void PrintTo(const Fault& fault, std::ostream* stream) { *stream << fault.name; }

void TellWrong(FakeTrainingDevice& device, std::size_t begin, std::size_t end)
{
  device.wrongBegin = begin;
  device.wrongEnd = end;
}

const Fault Faults[] = {
    {"Loss", [](FakeTrainingDevice& device) { device.wrongLoss = 0.01f; }},
    {"LossThatIsNoNumber", [](FakeTrainingDevice& device) { device.wrongLoss = NAN; }},
    {"Weights",
     [](FakeTrainingDevice& device) {
       TellWrong(device, 0, inr::Layout(TinyDescription()).gridOffset / 2);
     }},
    {"Grid",
     [](FakeTrainingDevice& device) {
       const inr::Layout layout(TinyDescription());
       TellWrong(device, layout.gridOffset, layout.parameterCount);
     }},
    {"LostWhenItBegins", [](FakeTrainingDevice& device) { device.failsAt = device.calls + 1; }},
    {"LostAtWork", [](FakeTrainingDevice& device) { device.failsAt = device.calls + 2; }},
    {"LostWhenItTells", [](FakeTrainingDevice& device) { device.failsAt = device.calls + 3; }},
};

class FirstStep : public testing::TestWithParam<Fault>
{};

/// It is the CPU's then, and one step: with that one's error, and the CPU goes on behind it.
TEST_P(FirstStep, OfALyingDeviceIsTakenOnce)
{
  FakeTrainingDevice device;
  FewSteps few(device);
  GetParam().bring(device);
  FewBatches batches;
  for (std::uint64_t step = 1; step <= 4; ++step) {
    const std::optional<double> loss = few.Descent.step(few.Batches);
    ASSERT_TRUE(loss);
    EXPECT_EQ(*loss, *few.Expected.step(batches));
    few.expect(step);
    EXPECT_EQ(Bytes(few.Descent), Bytes(few.Expected));
    EXPECT_FALSE(few.Descent.isAccelerated());
    EXPECT_FALSE(few.Descent.hasUsedDevice());
  }
  ASSERT_EQ(few.Told.size(), 1u);
  EXPECT_NE(few.Told[0].find("goes on with the training after 1 steps"), std::string::npos)
      << few.Told[0];
  EXPECT_EQ(few.Told[0].find("again"), std::string::npos) << few.Told[0];
}

/// The same where a training goes on from a checkpoint.
TEST_P(FirstStep, AfterOthersIsTakenOnce)
{
  FakeTrainingDevice device;
  FewSteps few(device);
  FewBatches batches;
  while (few.Expected.steps() < 300) { // and the learning rate has begun to fall
    few.Expected.step(batches);
  }
  const std::vector<std::vector<char>> before = Bytes(few.Expected);
  const inr::StateArrays arrays = few.Descent.state();
  for (std::size_t k = 0; k < arrays.size(); ++k) {
    std::copy(before[k].begin(), before[k].end(), static_cast<char*>(arrays[k].data));
  }
  few.Descent.goOnAfter(300);
  GetParam().bring(device);
  for (std::uint64_t step = 301; step <= 303; ++step) {
    EXPECT_EQ(*few.Descent.step(few.Batches), *few.Expected.step(batches));
    few.expect(step);
  }
  EXPECT_FALSE(few.Descent.isAccelerated());
  ASSERT_EQ(few.Told.size(), 1u);
  EXPECT_NE(few.Told[0].find("after 301 steps"), std::string::npos) << few.Told[0];
}

/// Steps of layers have become small by then.
TEST(AcceleratedDescent, NoticesLateThatALayerStays)
{
  constexpr std::uint64_t planned = 100000;
  for (const bool stays : {false, true}) {
    FakeTrainingDevice device;
    device.stays = stays ? inr::Layout(TinyDescription()).layers[1].offset : 0;
    device.planned = planned;
    FewSteps few(device);
    few.Descent.plan(planned);
    device.planned = planned;
    few.Descent.goOnAfter(50000);
    few.Descent.step(few.Batches);
    EXPECT_EQ(few.Descent.isAccelerated(), !stays);
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, FirstStep, testing::ValuesIn(Faults),
                         [](const testing::TestParamInfo<Fault>& info) {
                           return std::string(info.param.name);
                         });

} // namespace test::accelerated_descent
