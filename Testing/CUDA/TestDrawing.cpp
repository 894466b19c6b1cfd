// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that the kernels draw through a cache on the device, against those of Core's renderer.
#include "Core/Image/Metrics.h"
#include "Testing/CUDA/EmulatedAccelerator.h"
#include "Testing/Core/Render/VoxelScene.h"
#include "Testing/Core/Training/Fields.h"

#include <algorithm>
#include <functional>

namespace {

const inr::ModelPointer& TrainedModel()
{
  static const inr::ModelPointer model = [] {
    const Field<float> field = Waves();
    return inr::TrainModel(field.data(), {}, Steps(100));
  }();
  return model;
}

inr::RendererOptions OptionsWith(std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options;
  options.threads = 2;
  options.cache = Options(inr::CachePrecision::Bits16, 12);
  options.accelerator = std::move(accelerator);
  return options;
}

std::shared_ptr<const inr::Accelerator> Device(HostLaunch launch = {})
{
  return std::make_shared<EmulatedAccelerator>(inr::cuda::Precision::Float32, Duty::InfersAndDraws,
                                               launch);
}

inr::TransferFunction ColoursOf(const inr::VolumeInfo& volume)
{
  inr::TransferFunction colours = Colours();
  colours.low = volume.low;
  colours.high = volume.high;
  return colours;
}

inr::Renderer RendererOf(const inr::RendererOptions& options)
{
  inr::Renderer renderer(TrainedModel(), options);
  renderer.setTransferFunction(ColoursOf(TrainedModel()->volume));
  return renderer;
}

inr::Frame PlainFrame()
{
  inr::Frame frame = Oblique(glm::dvec3(TrainedModel()->volume.dims));
  frame.levelOfDetailScale = 1;
  return frame;
}

struct Drawn
{
  inr::Image rgba;
  inr::Image depth;
  inr::Image samples;
  inr::FrameStatistics statistics;
};

Drawn Draw(const inr::Frame& frame, const inr::RendererOptions& options)
{
  inr::Renderer renderer = RendererOf(options);
  Drawn drawn;
  drawn.statistics = renderer.render(frame, drawn.rgba, &drawn.depth, {}, &drawn.samples);
  EXPECT_FALSE(renderer.acceleratorFailure()) << renderer.acceleratorFailure()->reason;
  return drawn;
}

struct Case
{
  const char* name;
  std::function<void(inr::Frame&)> change;
};

void PrintTo(const Case& which, std::ostream* stream) { *stream << which.name; }

class Drawing : public testing::TestWithParam<Case>
{};

TEST_P(Drawing, GivesThePicturesOfTheCpu)
{
  inr::Frame frame = PlainFrame();
  GetParam().change(frame);
  const Drawn truth = Draw(frame, OptionsWith(nullptr));
  ASSERT_GT(*std::max_element(truth.rgba.pixels.begin(), truth.rgba.pixels.end()), 0.1f);
  const Drawn drawn = Draw(frame, OptionsWith(Device()));
  std::cout << inr::ImagePsnr(drawn.rgba, truth.rgba) << " dB\n";
  EXPECT_GE(inr::ImagePsnr(drawn.rgba, truth.rgba), 60);
  EXPECT_TRUE(drawn.statistics.complete);
  EXPECT_EQ(drawn.statistics.missed, 0);
  EXPECT_EQ(drawn.statistics.rays, truth.statistics.rays);
}

/// Rows of rising depth, in front of, inside and behind the volume.
const std::vector<float>& SomeDepth()
{
  static const std::vector<float> depth = [] {
    const inr::Frame frame = PlainFrame();
    std::vector<float> values(static_cast<std::size_t>(frame.width) * frame.height, 1.0f);
    for (std::size_t k = 0; k < values.size() / 2; ++k) {
      values[k] = 0.5f + 0.5f * static_cast<float>(k) / static_cast<float>(values.size() / 2);
    }
    return values;
  }();
  return depth;
}

inr::Light LightOf(inr::LightKind kind)
{
  const glm::dvec3 dims(TrainedModel()->volume.dims);
  inr::Light light;
  light.kind = kind;
  light.position = dims * glm::dvec3(1.5, 1.4, 1.3);
  light.direction =
      kind == inr::LightKind::Directional ? glm::dvec3(1, -2, -1) : 0.5 * dims - light.position;
  light.color = glm::vec3(1.0f, 0.8f, 0.6f);
  return light;
}

void LightUp(inr::Frame& frame)
{
  frame.lights = {LightOf(inr::LightKind::Point), LightOf(inr::LightKind::Directional),
                  LightOf(inr::LightKind::Spot)};
}

/// Through the middle of the volume.
glm::dvec4 PlaneAcross(const glm::dvec3& normal)
{
  return {normal, -glm::dot(normal, 0.5 * glm::dvec3(TrainedModel()->volume.dims))};
}

std::function<void(inr::Frame&)> Projected(inr::BlendMode mode)
{
  return [mode](inr::Frame& frame) { frame.blending.mode = mode; };
}

void Crop(inr::Frame& frame)
{
  const glm::dvec3 dims(TrainedModel()->volume.dims);
  frame.cropping = inr::Cropping{0.3 * dims, 0.62 * dims, 0x5555555};
}

const Case Marched[] = {
    {"Plain", [](inr::Frame&) {}},
    {"FullResolution", [](inr::Frame& frame) { frame.levelOfDetailScale = 0; }},
    {"MixedLevels", [](inr::Frame& frame) { frame.levelOfDetailScale = 2.5; }},
    {"EverySample", [](inr::Frame& frame) { frame.adaptiveSampling = false; }},
    {"Fine", [](inr::Frame& frame) { frame.sampleDistance = 0.11; }},
    {"Lit",
     [](inr::Frame& frame) {
       frame.shading = inr::Material();
       LightUp(frame);
     }},
    {"LitMixedLevels",
     [](inr::Frame& frame) {
       frame.shading = inr::Material();
       frame.levelOfDetailScale = 2.5;
       LightUp(frame);
     }},
    {"Largest", Projected(inr::BlendMode::MaximumIntensity)},
    {"Smallest", Projected(inr::BlendMode::MinimumIntensity)},
    {"Average", Projected(inr::BlendMode::AverageIntensity)},
    {"Sum", Projected(inr::BlendMode::Additive)},
    {"Cropped", Crop},
    {"Clipped",
     [](inr::Frame& frame) {
       frame.clippingPlanes = {PlaneAcross({1, 0.3, -0.2})};
     }},
    {"Piece",
     [](inr::Frame& frame) {
       frame.piece = {PlaneAcross({0.1, 1, 0.4})};
     }},
    {"BehindSomething", [](inr::Frame& frame) { frame.opaqueDepth = SomeDepth().data(); }},
    {"OneColumn", [](inr::Frame& frame) { frame.width = 1; }},
};

std::string NameOfCase(const testing::TestParamInfo<Case>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Kernels, Drawing, testing::ValuesIn(Marched), NameOfCase);

/// Where the depth of a picture differs, as far as both have one.
double LargestDifference(const inr::Image& a, const inr::Image& b)
{
  double largest = 0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(a.pixels[k]) - b.pixels[k]));
  }
  return largest;
}

TEST(Drawing, GivesDepthsAndSamplesToo)
{
  const inr::Frame frame = PlainFrame();
  const Drawn truth = Draw(frame, OptionsWith(nullptr));
  const Drawn drawn = Draw(frame, OptionsWith(Device()));
  EXPECT_LT(LargestDifference(drawn.depth, truth.depth), 1e-4);
  // The CPU leaves out samples where the voxels around show nothing.
  for (std::size_t k = 0; k < truth.samples.pixels.size(); k += 2) {
    ASSERT_GE(drawn.samples.pixels[k], truth.samples.pixels[k]) << k;
  }
  EXPECT_EQ(drawn.statistics.samples, truth.statistics.samples + truth.statistics.hidden);
}

/// In which order threads come makes no difference, nor how many there are.
TEST(Drawing, DoesNotDependOnTheOrderOfThreads)
{
  inr::Frame frame = PlainFrame();
  frame.levelOfDetailScale = 2.5;
  HostLaunch backward;
  backward.backward = true;
  HostLaunch few;
  few.blocks = 1;
  for (const inr::RenderMode mode : {inr::RenderMode::RayMarching, inr::RenderMode::PathTracing}) {
    frame.mode = mode;
    frame.samplesPerPixel = 1;
    const Drawn forward = Draw(frame, OptionsWith(Device()));
    EXPECT_EQ(Draw(frame, OptionsWith(Device(backward))).rgba.pixels, forward.rgba.pixels);
    EXPECT_EQ(Draw(frame, OptionsWith(Device(few))).rgba.pixels, forward.rgba.pixels);
  }
}

} // namespace
