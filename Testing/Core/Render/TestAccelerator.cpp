// SPDX-License-Identifier: BSD-3-Clause
//
// What an accelerator computes for a renderer.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Tiles/Tiling.h"
#include "Testing/Core/Render/AcceleratedScene.h"

#include <optional>

namespace test::accelerator {

TEST(Accelerator, ComputesWhatPicturesNeed)
{
  const inr::ModelPointer model = SomeModel();
  for (const Way way : Ways) {
    SCOPED_TRACE(static_cast<int>(way));
    const inr::Image truth = Truth(model, way);
    const auto device = std::make_shared<FakeDevice>();
    inr::Renderer renderer =
        RendererFor(model, way, std::make_shared<FakeAccelerator>(device, nullptr, "baseline"));
    const int checks = device->calls;
    EXPECT_EQ(checks, IsCached(way) ? 2 : 1);
    const inr::Image image = Finish(renderer, FrameFor(way));
    EXPECT_GE(inr::ImagePsnr(image, truth), 50);
    EXPECT_GT(device->calls, checks);
    EXPECT_EQ(device->alive, 1);
    EXPECT_EQ(renderer.accelerator(), "Fake device");
    EXPECT_FALSE(renderer.acceleratorFailure());
  }
}

TEST(Accelerator, IsSharedByTheViewsOfAVolume)
{
  const inr::ModelPointer model = SomeModel();
  const auto device = std::make_shared<FakeDevice>();
  const auto accelerator = std::make_shared<FakeAccelerator>(device);
  inr::Renderer one = RendererFor(model, Way::Still, accelerator);
  inr::Renderer other = RendererFor(model, Way::Still, accelerator);
  inr::Renderer alone = RendererFor(model, Way::Still, nullptr);
  EXPECT_EQ(device->made, 1);
  Finish(one, FrameFor(Way::Still));
  inr::Image image;
  EXPECT_EQ(other.render(FrameFor(Way::Still), image).work.bricks.bricks, 0);
  EXPECT_EQ(alone.cachedBricks(), 0); // whose values are not quite the same
  device->failsAt = 0;
  inr::Frame finer = FrameFor(Way::Still);
  finer.levelOfDetailScale = 0;
  Finish(one, finer);
  EXPECT_TRUE(other.acceleratorFailure());
  EXPECT_EQ(other.accelerator(), "");
}

/// Of a time series, only the step that is shown is in the device's memory; bricks of others wait.
TEST(Accelerator, KeepsNothingForBricksThatWait)
{
  const inr::ModelPointer model = SomeModel();
  const auto device = std::make_shared<FakeDevice>();
  const auto accelerator = std::make_shared<FakeAccelerator>(device);
  std::optional<inr::Renderer> renderer(RendererFor(model, Way::Still, accelerator));
  const std::vector<float> pixels = Finish(*renderer, FrameFor(Way::Still)).pixels;
  EXPECT_TRUE(accelerator->find(model));
  const std::shared_ptr<const inr::KeptBricks> kept = renderer->keepBricks();
  renderer.reset();
  EXPECT_EQ(device->alive, 0);
  EXPECT_FALSE(accelerator->find(model));
  renderer.emplace(RendererFor(model, Way::Still, accelerator));
  EXPECT_EQ(device->alive, 1);
  inr::Image image;
  EXPECT_EQ(renderer->render(FrameFor(Way::Still), image).work.bricks.bricks, 0);
  EXPECT_EQ(image.pixels, pixels);
  const int calls = device->calls;
  inr::Frame finer = FrameFor(Way::Still);
  finer.levelOfDetailScale = 0;
  renderer->render(finer, image);
  EXPECT_GT(device->calls, calls);
}

TEST(Accelerator, IsOfNoUseForOtherFields)
{
  const auto device = std::make_shared<FakeDevice>();
  const inr::Renderer renderer(std::make_shared<FieldEvaluator>(Waves), VolumeOf(AcceleratedDims),
                               {},
                               OptionsFor(Way::Still, std::make_shared<FakeAccelerator>(device)));
  EXPECT_EQ(device->made, 0);
  EXPECT_EQ(renderer.accelerator(), "");
}

TEST(Accelerator, IsAskedForManyPointsAtOnce)
{
  EXPECT_EQ(inr::EdgeFor(0, 8), inr::Tiling::Edge);
  EXPECT_EQ(inr::EdgeFor(1 << 15, 8), 64);
  EXPECT_EQ(inr::EdgeFor(1 << 15, 1), 128);
  const inr::ModelPointer model = SomeModel();
  for (const Way way : {Way::Network, Way::NetworkPaths}) {
    const auto device = std::make_shared<FakeDevice>();
    inr::Renderer renderer = RendererFor(model, way, std::make_shared<FakeAccelerator>(device));
    inr::Image image;
    const inr::FrameStatistics statistics = renderer.render(FrameFor(way), image);
    EXPECT_EQ(statistics.rays > 0, true);
    EXPECT_GT(statistics.samples, 0);
    EXPECT_LT(device->calls, 200); // 9 usual tiles, of some hundred calls each
  }
}

} // namespace test::accelerator
