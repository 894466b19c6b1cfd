// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures straight from the network by the kernels, against those of Core's renderer.
#include "Testing/CUDA/DrawingScene.h"
#include "Testing/CUDA/EmulatedRenderers.h"
#include "Testing/CUDA/FailingMachine.h"
#include "Testing/CUDA/MarchedCases.h"

#include <algorithm>
#include <cmath>

namespace test::network_drawing {

/// Draws such pictures by waves of some size, as a launch is imitated; or on a failing machine.
class NetworkAccelerator : public EmulatedAccelerator
{
public:
  explicit NetworkAccelerator(HostLaunch launch, const inr::cuda::WaveSizes& sizes = {},
                              std::shared_ptr<FailingOrders> orders = nullptr)
      : EmulatedAccelerator(inr::cuda::Precision::Float32, Duty::InfersAndDraws, launch),
        Launch(launch), Sizes(sizes), Orders(std::move(orders))
  {}

  std::shared_ptr<inr::AcceleratedRenderer>
  makeNetworkRenderer(const inr::ModelPointer& model) const override
  {
    EmulatedInference inference = this->inferenceOf(model);
    return this->Orders
               ? MakeNetworkRendererOn<FailingMachine>(this->Orders, inference, this->Sizes)
               : MakeNetworkRendererOn<HostMachine>(this->Launch, inference, this->Sizes);
  }

private:
  HostLaunch Launch;
  inr::cuda::WaveSizes Sizes;
  std::shared_ptr<FailingOrders> Orders;
};

std::shared_ptr<const inr::Accelerator> Failing(std::shared_ptr<FailingOrders> orders,
                                                const inr::cuda::WaveSizes& sizes = {})
{
  return std::make_shared<NetworkAccelerator>(HostLaunch(), sizes, std::move(orders));
}

inr::RendererOptions Uncached(std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options = OptionsWith(std::move(accelerator));
  options.cached = false;
  return options;
}

inr::Frame LitFrame(inr::RenderMode mode)
{
  inr::Frame frame = SmallFrame(mode);
  Shade(frame);
  frame.paths.ambientLight = glm::vec3(0.3f, 0.4f, 0.5f);
  return frame;
}

bool ShowsSomething(const inr::Image& image)
{
  return *std::max_element(image.pixels.begin(), image.pixels.end()) > 0.1f;
}

void ExpectAsMany(std::int64_t drawn, std::int64_t truth)
{
  // Rounding ends a few rays a round earlier or later.
  EXPECT_NEAR(static_cast<double>(drawn), static_cast<double>(truth),
              1e-3 * static_cast<double>(truth));
}

class NetworkDrawingOf : public CaseInAPlace
{};

TEST_P(NetworkDrawingOf, GivesThePicturesOfTheCpu)
{
  const auto& [place, which] = GetParam();
  inr::Frame frame = PlainFrame();
  which.change(frame);
  const Drawn truth = Draw(frame, Uncached(nullptr));
  ASSERT_TRUE(ShowsSomething(truth.rgba));
  const Drawn drawn = Draw(frame, Uncached(DeviceIn(place)));
  EXPECT_TRUE(drawn.statistics.accelerated);
  std::cout << inr::ImagePsnr(drawn.rgba, truth.rgba) << " dB\n";
  // A GPU rounds logarithms and powers in its own way.
  EXPECT_GE(inr::ImagePsnr(drawn.rgba, truth.rgba), place == Place::Gpu ? 60 : 100);
  EXPECT_LT(Others(drawn.depth, truth.depth, 1e-4f), 0.01);
  EXPECT_TRUE(drawn.samples.pixels.empty());
  EXPECT_TRUE(drawn.statistics.complete);
  EXPECT_EQ(drawn.statistics.rays, truth.statistics.rays);
  ExpectAsMany(drawn.statistics.samples, truth.statistics.samples);
  ExpectAsMany(drawn.statistics.clamped, truth.statistics.clamped);
  ExpectAsMany(drawn.statistics.work.networkSamples, truth.statistics.work.networkSamples);
  ExpectAsMany(drawn.statistics.work.gradients, truth.statistics.work.gradients);
}

INSTANTIATE_TEST_SUITE_P(Kernels, NetworkDrawingOf,
                         testing::Combine(testing::Values(Place::Host, Place::Gpu),
                                          testing::ValuesIn(MarchedCases())),
                         CaseInAPlace::nameOf);

class NetworkPaths : public CaseInAPlace
{};

INSTANTIATE_TEST_SUITE_P(Kernels, NetworkPaths,
                         testing::Combine(testing::Values(Place::Host, Place::Gpu),
                                          testing::Values(Case{"Plain", [](inr::Frame&) {}},
                                                          Case{"Layered", AddLayers})),
                         CaseInAPlace::nameOf);

/// Paths meet the same random numbers; a few may part ways for rounding.
TEST_P(NetworkPaths, AreThoseOfTheCpu)
{
  const auto& [place, which] = GetParam();
  inr::Frame frame = PlainFrame();
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 3;
  frame.paths.ambientLight = glm::vec3(0.3f, 0.4f, 0.5f);
  frame.paths.anisotropy = 0.4;
  frame.clippingPlanes = {PlaneAcross({1, 0.3, -0.2})};
  frame.opaqueDepth = SomeDepth().data();
  LightUp(frame);
  which.change(frame);
  const Drawn truth = Draw(frame, Uncached(nullptr));
  ASSERT_TRUE(ShowsSomething(truth.rgba));
  const Drawn drawn = Draw(frame, Uncached(DeviceIn(place)));
  EXPECT_TRUE(drawn.statistics.accelerated);
  EXPECT_LT(Others(drawn.rgba, truth.rgba, 1e-3f), 0.01);
  EXPECT_LT(Others(drawn.depth, truth.depth, 1e-4f), 0.01);
  EXPECT_EQ(drawn.statistics.paths, 3);
  EXPECT_EQ(drawn.statistics.rays, truth.statistics.rays);
  const auto about = [](std::int64_t count) { return 0.01 * static_cast<double>(count); };
  EXPECT_NEAR(static_cast<double>(drawn.statistics.work.networkSamples),
              static_cast<double>(truth.statistics.work.networkSamples),
              about(truth.statistics.work.networkSamples));
  EXPECT_NEAR(static_cast<double>(drawn.statistics.work.scatterings),
              static_cast<double>(truth.statistics.work.scatterings),
              about(truth.statistics.work.scatterings));
  EXPECT_NEAR(static_cast<double>(drawn.statistics.work.lightSteps),
              static_cast<double>(truth.statistics.work.lightSteps),
              about(truth.statistics.work.lightSteps));
}

/// However few rays go on together, and in which order threads come.
TEST(NetworkDrawing, DependsNeitherOnTheSizeOfWavesNorOnTheOrderOfThreads)
{
  HostLaunch backward;
  backward.backward = true;
  HostLaunch few;
  few.blocks = 1;
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = LitFrame(mode);
    const Drawn drawn = Draw(frame, Uncached(Device()));
    ASSERT_TRUE(ShowsSomething(drawn.rgba));
    const auto with = [&](HostLaunch launch, const inr::cuda::WaveSizes& sizes) {
      return Draw(frame, Uncached(std::make_shared<NetworkAccelerator>(launch, sizes)));
    };
    for (const std::int64_t most : {5, 37, 200}) {
      const Drawn small = with({}, {most, most});
      EXPECT_EQ(small.rgba.pixels, drawn.rgba.pixels) << most;
      EXPECT_EQ(small.depth.pixels, drawn.depth.pixels) << most;
      EXPECT_EQ(small.statistics.samples, drawn.statistics.samples) << most;
      EXPECT_EQ(small.statistics.rays, drawn.statistics.rays) << most;
    }
    EXPECT_EQ(with(backward, {37, 37}).rgba.pixels, drawn.rgba.pixels);
    EXPECT_EQ(with(few, {}).rgba.pixels, drawn.rgba.pixels);
  }
}

/// Frames of other sizes and kinds, one after another by the same renderer.
TEST(NetworkDrawing, DrawsOneFrameAfterAnother)
{
  inr::Renderer renderer = RendererOf(Uncached(Device()));
  for (const inr::RenderMode mode : {Modes[0], Modes[1], Modes[0]}) {
    for (const bool lit : {false, true}) {
      for (const int width : {6, 20, 9}) {
        inr::Frame frame = LitFrame(mode);
        frame.width = width;
        if (!lit) {
          frame.shading.reset();
        }
        inr::Image image;
        EXPECT_TRUE(renderer.render(frame, image).complete);
        EXPECT_EQ(image.pixels, Draw(frame, Uncached(Device())).rgba.pixels);
      }
    }
  }
}

TEST(NetworkDrawing, StopsWhenItIsAskedTo)
{
  for (const inr::RenderMode mode : Modes) {
    const auto orders = std::make_shared<FailingOrders>();
    inr::Renderer renderer = RendererOf(Uncached(Failing(orders, {3, 3})));
    const inr::Frame frame = LitFrame(mode);
    inr::Image image;
    renderer.render(frame, image); // nothing is left to be proven
    const inr::Image whole = image;
    inr::Frame next = frame;
    next.seed = 1;
    for (const int most : {0, 1, 3}) {
      int asked = 0;
      const int before = orders->orders;
      try {
        renderer.render(next, image, nullptr, [&] { return asked++ < most; });
        ADD_FAILURE() << "it went on";
      } catch (const inr::Error& error) {
        EXPECT_EQ(error.code(), inr::ErrorCode::Cancelled);
      }
      EXPECT_EQ(asked, most + 1);
      const int done = (orders->orders - before) / inr::cuda::WaveCounts::Rounds;
      EXPECT_EQ(done > 0, most > 0);
      EXPECT_LE(done, 3 * most + 1); // kernels of a round
    }
    renderer.render(frame, image);
    EXPECT_EQ(image.pixels, whole.pixels);
    EXPECT_FALSE(renderer.acceleratorFailure());
  }
}

/// Whatever it was told last.
TEST(NetworkDrawing, LeavesAllToTheCpuWhenTheDeviceIsLost)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = LitFrame(mode);
    const Drawn truth = Draw(frame, Uncached(nullptr));
    const auto counting = std::make_shared<FailingOrders>();
    ASSERT_TRUE(Draw(frame, Uncached(Failing(counting))).statistics.accelerated);
    const int last = counting->orders - 8; // the picture is on its way to the host
    ASSERT_GT(last, 50);
    for (int order = 0; order < counting->orders; order += order < 30 || order > last ? 1 : 23) {
      const auto orders = std::make_shared<FailingOrders>();
      orders->failsAt = order;
      inr::Renderer renderer = RendererOf(Uncached(Failing(orders)));
      inr::Image image;
      inr::Image depth;
      EXPECT_TRUE(renderer.render(frame, image, &depth).complete);
      EXPECT_EQ(image.pixels, truth.rgba.pixels) << order;
      EXPECT_EQ(depth.pixels, truth.depth.pixels) << order;
      EXPECT_TRUE(renderer.acceleratorFailure()) << order;
      EXPECT_EQ(orders->orders, order + 1) << "it was asked again";
    }
  }
}

/// One that draws another picture is found out at the first.
TEST(NetworkDrawing, IsNotTrustedUnseen)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = LitFrame(mode);
    const auto orders = std::make_shared<FailingOrders>();
    orders->lies = true;
    inr::Renderer renderer = RendererOf(Uncached(Failing(orders)));
    inr::Image image;
    EXPECT_FALSE(renderer.render(frame, image).accelerated);
    ASSERT_TRUE(renderer.acceleratorFailure());
    EXPECT_NE(renderer.acceleratorFailure()->reason.find("from the CPU's"), std::string::npos);
    EXPECT_EQ(image.pixels, Draw(frame, Uncached(nullptr)).rgba.pixels);
  }
}

class LeftToTheCpu : public testing::TestWithParam<Case>
{};

INSTANTIATE_TEST_SUITE_P(
    NetworkDrawing, LeftToTheCpu,
    testing::Values(Case{"Surfaces",
                         [](inr::Frame& frame) {
                           frame.blending.mode = inr::BlendMode::Isosurface;
                           frame.blending.isosurfaces = {0.3};
                         }},
                    Case{"PreIntegration", [](inr::Frame& frame) { frame.preIntegration = true; }}),
    [](const auto& info) { return info.param.name; });

/// What kernels do not draw without a cache they infer.
TEST_P(LeftToTheCpu, IsInferredByTheDevice)
{
  inr::Frame frame = LitFrame(inr::RenderMode::RayMarching);
  const inr::Image plain = Draw(frame, Uncached(nullptr)).rgba;
  GetParam().change(frame);
  const Drawn truth = Draw(frame, Uncached(nullptr));
  ASSERT_TRUE(ShowsSomething(truth.rgba));
  EXPECT_LT(inr::ImagePsnr(truth.rgba, plain), 50);
  const Drawn drawn = Draw(frame, Uncached(Device()));
  EXPECT_FALSE(drawn.statistics.accelerated);
  EXPECT_GE(inr::ImagePsnr(drawn.rgba, truth.rgba), 60);
}

/// How many of a thousand values leave float32's range on their way.
std::int64_t Marked(const inr::ModelPointer& model, HostLaunch launch)
{
  std::vector<float> places;
  std::vector<float> values(1000);
  for (std::size_t k = 0; k < 3 * values.size(); ++k) {
    places.push_back(static_cast<float>(inr::RandomUnit(3, k)));
  }
  EmulatedModel(model, inr::cuda::Precision::Float32, launch)
      .inferPoints(places.data(), 1000, values.data());
  const auto isMarked = [](float value) { return std::isnan(value); };
  return std::count_if(values.begin(), values.end(), isMarked);
}

/// With parameters so large that some do, and others do not.
inr::ModelPointer Overflowing(HostLaunch launch)
{
  auto model = std::make_shared<inr::Model>(*TrainedModel());
  while (Marked(model, launch) < 50) {
    for (float& parameter : model->parameters) {
      parameter *= 1.5f;
    }
  }
  return model;
}

TEST(NetworkDrawing, HasCoreComputeWhatOverflows)
{
  HostLaunch launch;
  launch.overflows = true;
  const inr::ModelPointer model = Overflowing(launch);
  ASSERT_LT(Marked(model, launch), 950);
  for (const inr::RenderMode mode : Modes) {
    for (const bool lit : {false, true}) {
      inr::Frame frame = LitFrame(mode);
      if (!lit) {
        frame.shading.reset();
      }
      const auto draw = [&](std::shared_ptr<const inr::Accelerator> accelerator) {
        const bool accelerated = accelerator != nullptr;
        inr::Renderer renderer(model, Uncached(std::move(accelerator)));
        renderer.setTransferFunction(ColoursOf(model->volume));
        inr::Image image;
        EXPECT_EQ(renderer.render(frame, image).accelerated, accelerated);
        EXPECT_FALSE(renderer.acceleratorFailure()) << renderer.acceleratorFailure()->reason;
        return image;
      };
      const inr::Image truth = draw(nullptr);
      ASSERT_TRUE(ShowsSomething(truth));
      const inr::Image image = draw(std::make_shared<NetworkAccelerator>(launch));
      EXPECT_LT(Others(image, truth, 1e-3f), 0.01);
    }
  }
}

} // namespace test::network_drawing
