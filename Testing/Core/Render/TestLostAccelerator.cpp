// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of pictures when an accelerator fails, or is not to be trusted.
#include "Testing/Core/Render/AcceleratedScene.h"

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

namespace test::lost_accelerator {

/// Whatever is on its way when the device is lost, nobody sees it, and nobody asks it again.
TEST(Accelerator, MayFailAtAnyCall)
{
  const inr::ModelPointer model = SomeModel();
  for (const Way way : Ways) {
    const inr::Image truth = Truth(model, way);
    ASSERT_GT(Spread(truth), 0.05) << "nothing to be seen " << static_cast<int>(way);
    const auto counting = std::make_shared<FakeDevice>();
    inr::Renderer whole = RendererFor(model, way, std::make_shared<FakeAccelerator>(counting));
    ASSERT_EQ(Finish(whole, FrameFor(way)).pixels, truth.pixels) << static_cast<int>(way);
    const int calls = counting->calls;
    const int step = std::max(1, calls / 6);
    for (int fails = 0; fails < calls; fails += fails < 4 ? 1 : step) {
      SCOPED_TRACE(std::to_string(static_cast<int>(way)) + " at " + std::to_string(fails) + " of " +
                   std::to_string(calls));
      const auto device = std::make_shared<FakeDevice>();
      device->failsAt = fails;
      inr::Renderer renderer = RendererFor(model, way, std::make_shared<FakeAccelerator>(device));
      const inr::Image image = Finish(renderer, FrameFor(way));
      ASSERT_EQ(image.pixels, truth.pixels);
      if (way == Way::InTime && device->refused == 0) {
        continue; // how many calls frames in time make is the machine's business
      }
      ASSERT_TRUE(renderer.acceleratorFailure());
      EXPECT_EQ(renderer.acceleratorFailure()->reason, "the fake device is lost");
      EXPECT_TRUE(renderer.acceleratorFailure()->atWork);
      EXPECT_EQ(renderer.accelerator(), "");
      EXPECT_EQ(device->alive, 0);   // its memory is given back
      EXPECT_LE(device->refused, 4); // each thread may have been in the midst of a call
      const int refused = device->refused;
      inr::Frame again = FrameFor(way);
      again.seed = 1;
      Finish(renderer, again);
      EXPECT_EQ(device->refused, refused);
    }
  }
}

/// What it has brought stays: only the rest is inferred by the CPU.
TEST(Accelerator, LosesNoBrick)
{
  const inr::ModelPointer model = SomeModel();
  const auto device = std::make_shared<FakeDevice>();
  inr::Renderer renderer =
      RendererFor(model, Way::Still, std::make_shared<FakeAccelerator>(device));
  inr::Image image;
  const std::int64_t first = renderer.render(FrameFor(Way::Still), image).work.bricks.bricks;
  ASSERT_GT(first, 20);
  const std::int64_t before = renderer.cachedBricks();
  device->failsAt = 0;
  inr::Frame finer = FrameFor(Way::Still);
  finer.levelOfDetailScale = 0;
  const std::int64_t second = renderer.render(finer, image).work.bricks.bricks;
  ASSERT_GT(second, 0);
  EXPECT_TRUE(renderer.acceleratorFailure());
  EXPECT_EQ(renderer.cachedBricks(), before + second);
  EXPECT_EQ(renderer.render(FrameFor(Way::Still), image).work.bricks.bricks, 0);
  EXPECT_EQ(image.pixels, Truth(model, Way::Still).pixels);
}

/// While nobody renders, the loader goes on behind the application.
TEST(Accelerator, MayFailBehindTheApplication)
{
  const inr::ModelPointer model = SomeModel();
  const auto device = std::make_shared<FakeDevice>();
  inr::Renderer renderer =
      RendererFor(model, Way::InTime, std::make_shared<FakeAccelerator>(device));
  inr::Image image;
  device->failsAt = device->calls + 3;
  inr::Frame frame = FrameFor(Way::InTime);
  for (int frames = 0; frames < 1000 && !renderer.acceleratorFailure(); ++frames) {
    renderer.render(frame, image);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(renderer.acceleratorFailure());
  EXPECT_EQ(Finish(renderer, frame).pixels, Truth(model, Way::InTime).pixels);
}

TEST(Accelerator, WithoutMemoryIsDoneWithout)
{
  const inr::ModelPointer model = SomeModel();
  for (const Way way : {Way::Still, Way::Network}) {
    const auto device = std::make_shared<FakeDevice>();
    device->hasMemory = false;
    const auto accelerator = std::make_shared<FakeAccelerator>(device);
    inr::Renderer renderer = RendererFor(model, way, accelerator);
    ASSERT_TRUE(renderer.acceleratorFailure());
    EXPECT_FALSE(renderer.acceleratorFailure()->atWork);
    EXPECT_NE(renderer.acceleratorFailure()->reason.find("no memory"), std::string::npos);
    EXPECT_TRUE(accelerator->hasFailed());
    EXPECT_EQ(Finish(renderer, FrameFor(way)).pixels, Truth(model, way).pixels);
    EXPECT_EQ(device->made, 1);
  }
}

TEST(Accelerator, ThatComputesSomethingElseIsNotUsed)
{
  const inr::ModelPointer model = SomeModel();
  for (const Way way : {Way::Still, Way::Network}) {
    const auto device = std::make_shared<FakeDevice>();
    device->error = 0.01f;
    inr::Renderer renderer = RendererFor(model, way, std::make_shared<FakeAccelerator>(device));
    ASSERT_TRUE(renderer.acceleratorFailure());
    EXPECT_TRUE(renderer.acceleratorFailure()->atWork);
    EXPECT_NE(renderer.acceleratorFailure()->reason.find("where the CPU gives"), std::string::npos);
    EXPECT_EQ(Finish(renderer, FrameFor(way)).pixels, Truth(model, way).pixels);
    EXPECT_EQ(device->alive, 0);
  }
}

} // namespace test::lost_accelerator
