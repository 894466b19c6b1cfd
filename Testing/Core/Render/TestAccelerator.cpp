// SPDX-License-Identifier: BSD-3-Clause
//
// What an accelerator computes for a renderer, and what becomes of pictures when it fails.
#include "Core/Image/Metrics.h"
#include "Testing/Core/FakeAccelerator.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <thread>

namespace {

const glm::i64vec3 Dims(60, 50, 40);

inr::ModelPointer SomeModel()
{
  auto model = RandomModel(SmallDescription());
  model->volume = VolumeOf(Dims);
  return model;
}

/// Everything is seen, whatever its value.
inr::TransferFunction Visible()
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    function.table.emplace_back(x, 1 - x, 0.5f, 0.02f + 0.1f * x);
  }
  return function;
}

enum class Way { Still, InTime, Tight, Network, Paths, NetworkPaths };
constexpr Way Ways[] = {Way::Still,   Way::InTime, Way::Tight,
                        Way::Network, Way::Paths,  Way::NetworkPaths};

bool IsCached(Way way) { return way != Way::Network && way != Way::NetworkPaths; }

inr::RendererOptions OptionsFor(Way way, std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cached = IsCached(way);
  options.cache = Options(inr::CachePrecision::Bits16, 12);
  options.cache.background = way == Way::InTime;
  options.cache.bytes = way == Way::Tight ? 150000 : 8 << 20;
  options.accelerator = std::move(accelerator);
  return options;
}

inr::Frame FrameFor(Way way)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 40);
  frame.levelOfDetailScale = 1; // levels that are filtered, too
  frame.timeLimit = way == Way::InTime ? 1e-3 : 0;
  frame.samplesPerPixel = 2;
  if (way == Way::Paths || way == Way::NetworkPaths) {
    frame.mode = inr::RenderMode::PathTracing;
    frame.paths.ambientLight = glm::vec3(1.0f);
  }
  return frame;
}

/// The complete picture.
inr::Image Finish(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  for (int frames = 0; frames < 20000; ++frames) {
    if (renderer.render(frame, image).complete) {
      return image;
    }
  }
  ADD_FAILURE() << "never complete";
  return image;
}

inr::Renderer RendererFor(const inr::ModelPointer& model, Way way,
                          std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::Renderer renderer(model, OptionsFor(way, std::move(accelerator)));
  renderer.setTransferFunction(Visible());
  return renderer;
}

/// By the CPU alone.
inr::Image Truth(const inr::ModelPointer& model, Way way)
{
  inr::Renderer renderer = RendererFor(model, way, nullptr);
  EXPECT_EQ(renderer.accelerator(), "");
  EXPECT_FALSE(renderer.acceleratorFailure());
  inr::Frame frame = FrameFor(way);
  frame.timeLimit = 0;
  return Finish(renderer, frame);
}

/// Standard deviation of red where there is something.
double Spread(const inr::Image& image)
{
  double count = 0, sum = 0, squares = 0;
  for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
    if (image.pixels[k + 3] > 0.5f) {
      const double red = static_cast<double>(image.pixels[k]);
      ++count;
      sum += red;
      squares += red * red;
    }
  }
  return std::sqrt(squares / count - sum / count * (sum / count));
}

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
  const inr::Renderer renderer(std::make_shared<FieldEvaluator>(Waves), VolumeOf(Dims), {},
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

} // namespace
