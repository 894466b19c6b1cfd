// SPDX-License-Identifier: BSD-3-Clause
//
// A device that draws some kind of picture wrong is found out when the first one of that kind is
// drawn, whatever it has drawn before.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/DrawingScene.h"

#include <atomic>

namespace test::proof {

/// A kind of picture that kernels make in a way of their own.
struct PictureKind
{
  std::string name;
  std::function<void(inr::Frame&)> change;
  std::function<bool(const inr::Frame&)> isIt;
  std::string wants;   ///< the kind that is proven before this one, if any
  bool cached = false; ///< drawn through a cache only
};

void PrintTo(const PictureKind& kind, std::ostream* stream) { *stream << kind.name; }

void CropToABox(inr::Frame& frame)
{
  Crop(frame);
  frame.cropping->flags = 1u << 13;
}

bool IsOfRays(const inr::Frame& frame) { return frame.mode == inr::RenderMode::RayMarching; }

bool IsCropped(const inr::Frame& frame)
{
  return frame.cropping && !inr::BoxOf(*frame.cropping).full;
}

PictureKind Blended(const std::string& name, inr::BlendMode mode)
{
  return {
      name,
      Projected(mode),
      [mode](const inr::Frame& frame) { return IsOfRays(frame) && frame.blending.mode == mode; },
      {}};
}

void TracePaths(inr::Frame& frame)
{
  frame.mode = inr::RenderMode::PathTracing;
  frame.paths.ambientLight = glm::vec3(1.0f);
}

const std::vector<PictureKind>& Kinds()
{
  static const std::vector<PictureKind> kinds = {
      {"Plain",
       [](inr::Frame&) {},
       [](const inr::Frame& frame) {
         return IsOfRays(frame) && frame.blending.mode == inr::BlendMode::Composite &&
                !frame.shading && !frame.layers && !IsCropped(frame) && !frame.preIntegration;
       },
       {}},
      {"Lit",
       [](inr::Frame& frame) { Shade(frame); },
       [](const inr::Frame& frame) { return IsOfRays(frame) && frame.shading && !frame.layers; },
       {}},
      {"Layered",
       AddLayers,
       [](const inr::Frame& frame) { return IsOfRays(frame) && frame.layers && !frame.shading; },
       {}},
      {"LitLayered",
       [](inr::Frame& frame) {
         AddLayers(frame);
         Shade(frame);
       },
       [](const inr::Frame& frame) { return IsOfRays(frame) && frame.layers && frame.shading; },
       {}},
      {"Cropped",
       Crop,
       [](const inr::Frame& frame) { return IsOfRays(frame) && IsCropped(frame); },
       {}},
      Blended("Largest", inr::BlendMode::MaximumIntensity),
      Blended("Smallest", inr::BlendMode::MinimumIntensity),
      Blended("Average", inr::BlendMode::AverageIntensity),
      Blended("Sum", inr::BlendMode::Additive),
      {"Surfaces",
       ShowSurfaces,
       [](const inr::Frame& frame) {
         return IsOfRays(frame) && frame.blending.mode == inr::BlendMode::Isosurface;
       },
       {},
       true},
      {"Integrated",
       [](inr::Frame& frame) { frame.preIntegration = true; },
       [](const inr::Frame& frame) { return IsOfRays(frame) && frame.preIntegration; },
       {},
       true},
      {"Paths", TracePaths,
       [](const inr::Frame& frame) { return !IsOfRays(frame) && !frame.layers; }, "Plain"},
      {"LayeredPaths",
       [](inr::Frame& frame) {
         TracePaths(frame);
         AddLayers(frame);
       },
       [](const inr::Frame& frame) { return !IsOfRays(frame) && frame.layers; }, "Layered"},
  };
  return kinds;
}

/// Draws as another one does, and then changes the pictures of a kind.
class LyingRenderer : public inr::AcceleratedRenderer
{
public:
  LyingRenderer(std::shared_ptr<inr::AcceleratedRenderer> honest, const PictureKind& wrong)
      : Honest(std::move(honest)), Wrong(wrong)
  {}

  bool draws(const inr::Frame& frame) const override { return this->Honest->draws(frame); }
  void setColors(const inr::Majorants& majorants, const inr::ColorLookup& colors) override
  {
    this->Honest->setColors(majorants, colors);
  }
  inr::FrameStatistics march(const inr::MarchJob& job, const inr::DrawCall& call) override
  {
    const inr::FrameStatistics statistics = this->Honest->march(job, call);
    if (this->Wrong.isIt(job.frame)) {
      spoil(call.output.rgba);
    }
    return statistics;
  }
  inr::TracedTiles tracePaths(const inr::PathRound& round, const inr::WorkLimit& limit,
                              const std::function<bool()>& keepGoing) override
  {
    inr::TracedTiles traced = this->Honest->tracePaths(round, limit, keepGoing);
    if (this->Wrong.isIt(round.tracer.frame())) {
      spoil(round.output.rgba);
    }
    return traced;
  }
  std::int64_t bytes() const override { return this->Honest->bytes(); }
  std::int64_t bricks() const override { return this->Honest->bricks(); }

private:
  /// Darker; what is behind shines through as it should.
  static void spoil(inr::Image& rgba)
  {
    for (std::size_t k = 0; k < rgba.pixels.size(); ++k) {
      rgba.pixels[k] *= k % 4 < 3 ? 0.7f : 1.0f;
    }
  }

  std::shared_ptr<inr::AcceleratedRenderer> Honest;
  PictureKind Wrong;
};

class LyingAccelerator : public EmulatedAccelerator
{
public:
  explicit LyingAccelerator(const PictureKind& wrong)
      : EmulatedAccelerator(inr::cuda::Precision::Float32, Duty::InfersAndDraws), Wrong(wrong)
  {}

  std::shared_ptr<inr::AcceleratedRenderer>
  makeRenderer(const inr::ModelPointer& model, const glm::i64vec3& dims,
               const inr::CacheOptions& options) const override
  {
    return std::make_shared<LyingRenderer>(
        this->EmulatedAccelerator::makeRenderer(model, dims, options), this->Wrong);
  }
  std::shared_ptr<inr::AcceleratedRenderer>
  makeNetworkRenderer(const inr::ModelPointer& model) const override
  {
    return std::make_shared<LyingRenderer>(this->EmulatedAccelerator::makeNetworkRenderer(model),
                                           this->Wrong);
  }

private:
  PictureKind Wrong;
};

inr::Frame FrameOf(const PictureKind& kind)
{
  inr::Frame frame = PlainFrame();
  frame.width = 20;
  frame.height = 15;
  frame.samplesPerPixel = 1;
  kind.change(frame);
  return frame;
}

inr::RendererOptions OptionsOf(bool cached, std::shared_ptr<const inr::Accelerator> accelerator)
{
  inr::RendererOptions options = OptionsWith(std::move(accelerator));
  options.cached = cached;
  return options;
}

inr::Renderer Liar(const PictureKind& wrong, bool cached)
{
  return RendererOf(OptionsOf(cached, std::make_shared<LyingAccelerator>(wrong)));
}

void ExpectDrawn(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  EXPECT_TRUE(renderer.render(frame, image).accelerated);
  EXPECT_FALSE(renderer.acceleratorFailure()) << renderer.acceleratorFailure()->reason;
}

/// And that the picture is the CPU's, in this call already.
void ExpectFoundOut(inr::Renderer& renderer, const inr::Frame& frame, bool cached)
{
  const Drawn truth = Draw(frame, OptionsOf(cached, nullptr));
  inr::Image image;
  EXPECT_FALSE(renderer.render(frame, image).accelerated);
  EXPECT_GE(inr::ImagePsnr(image, truth.rgba), 60);
  ASSERT_TRUE(renderer.acceleratorFailure());
  EXPECT_TRUE(renderer.acceleratorFailure()->atWork);
  EXPECT_NE(renderer.acceleratorFailure()->reason.find("from the CPU's"), std::string::npos)
      << renderer.acceleratorFailure()->reason;
}

class ProofOf : public testing::TestWithParam<std::tuple<bool, PictureKind>>
{};

TEST_P(ProofOf, IsAskedForThatKind)
{
  const auto& [cached, wrong] = GetParam();
  if (wrong.cached && !cached) {
    GTEST_SKIP() << "left to the CPU";
  }
  inr::Renderer renderer = Liar(wrong, cached);
  for (const PictureKind& kind : Kinds()) {
    const bool draws = cached || !kind.cached;
    if (draws && kind.name != wrong.name && kind.wants != wrong.name) { // see below

      SCOPED_TRACE(kind.name);
      ExpectDrawn(renderer, FrameOf(kind));
    }
  }
  ExpectFoundOut(renderer, FrameOf(wrong), cached);
}

INSTANTIATE_TEST_SUITE_P(Kernels, ProofOf,
                         testing::Combine(testing::Bool(), testing::ValuesIn(Kinds())),
                         [](const testing::TestParamInfo<std::tuple<bool, PictureKind>>& info) {
                           return (std::get<0>(info.param) ? "Cached" : "Network") +
                                  std::get<1>(info.param).name;
                         });

const PictureKind& KindNamed(const std::string& name)
{
  return *std::find_if(Kinds().begin(), Kinds().end(),
                       [&](const PictureKind& kind) { return kind.name == name; });
}

/// How often the renderer asks whether to go on: before each of the CPU's tiles, for instance.
std::int64_t Asked(inr::Renderer& renderer, const inr::Frame& frame)
{
  std::atomic<std::int64_t> asked{0};
  inr::Image image;
  EXPECT_TRUE(renderer.render(frame, image, nullptr, [&] { return ++asked > 0; }).accelerated);
  return asked;
}

/// Paths are compared at the coarsest level; what goes through the others is rays, beforehand.
TEST(Proof, OfPathsWantsThatOfRays)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = Liar(KindNamed("Plain"), cached);
    ExpectFoundOut(renderer, FrameOf(KindNamed("Paths")), cached);
  }
}

/// Where rays end at a box, nothing has to be looked at within it.
TEST(Proof, ThatABoxIsRightSaysNothingOfOtherRegions)
{
  inr::Renderer renderer = Liar(KindNamed("Cropped"), true);
  inr::Frame frame = FrameOf(KindNamed("Plain"));
  CropToABox(frame);
  ExpectDrawn(renderer, frame);
  ExpectFoundOut(renderer, FrameOf(KindNamed("Cropped")), true);
}

/// The test's colours, but so much fainter.
inr::TransferFunction Faint(float share)
{
  inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
  for (glm::vec4& color : colours.table) {
    color.w *= share;
  }
  return colours;
}

/// A picture in which there is nothing to be seen proves nothing.
TEST(Proof, WaitsForSomethingToBeSeen)
{
  for (const char* name : {"Plain", "Paths"}) {
    SCOPED_TRACE(name);
    inr::Renderer renderer = Liar(KindNamed(name), true);
    renderer.setTransferFunction(Faint(0));
    ExpectDrawn(renderer, FrameOf(KindNamed(name)));
    renderer.setTransferFunction(Faint(1));
    ExpectFoundOut(renderer, FrameOf(KindNamed(name)), true);
  }
}

/// What is wrong with next to nothing is wrong.
TEST(Proof, ComparesFaintPicturesToo)
{
  for (const char* name : {"Plain", "Lit", "Average"}) {
    SCOPED_TRACE(name);
    inr::Renderer honest = RendererOf(OptionsWith(Device()));
    honest.setTransferFunction(Faint(1e-3f));
    ExpectDrawn(honest, FrameOf(KindNamed(name)));
    inr::Renderer renderer = Liar(KindNamed(name), true);
    renderer.setTransferFunction(Faint(1e-3f));
    inr::Image image;
    EXPECT_FALSE(renderer.render(FrameOf(KindNamed(name)), image).accelerated);
    EXPECT_TRUE(renderer.acceleratorFailure());
  }
}

/// One device is given up by all that draw the same model with it.
TEST(Proof, IsOfTheDevice)
{
  const auto accelerator = std::make_shared<LyingAccelerator>(KindNamed("Plain"));
  inr::Renderer one = RendererOf(OptionsWith(accelerator));
  inr::Renderer other = RendererOf(OptionsWith(accelerator));
  ExpectDrawn(other, FrameOf(KindNamed("Largest")));
  ExpectFoundOut(one, FrameOf(KindNamed("Plain")), true);
  inr::Image image;
  EXPECT_FALSE(other.render(FrameOf(KindNamed("Largest")), image).accelerated);
}

/// Layers that are nowhere in sight prove nothing, but not for ever.
TEST(Proof, OfLayersIsNotTriedForEver)
{
  inr::Renderer renderer = RendererOf(OptionsWith(Device()));
  inr::Frame frame = FrameOf(KindNamed("Plain"));
  const auto pixels = static_cast<std::size_t>(frame.width) * frame.height;
  auto layers = std::make_shared<inr::TranslucentLayers>();
  layers->layers.push_back({std::vector<float>(pixels, 1.0f),
                            std::vector<glm::vec4>(pixels, glm::vec4(0.2f, 0.2f, 0.2f, 0.5f))});
  frame.layers = layers;
  std::vector<std::int64_t> asked;
  for (int k = 0; k < 5; ++k) {
    ++frame.seed;
    asked.push_back(Asked(renderer, frame));
  }
  EXPECT_EQ(asked[3], asked[2]); // the last try
  EXPECT_LT(asked[4], asked[3]);
}

/// The next picture of a kind is the device's alone.
TEST(Proof, IsAskedForOnce)
{
  inr::Renderer renderer = RendererOf(OptionsWith(Device()));
  for (const PictureKind& kind : Kinds()) {
    SCOPED_TRACE(kind.name);
    inr::Frame frame = FrameOf(kind);
    const std::int64_t before = Asked(renderer, frame);
    ++frame.seed;
    EXPECT_LT(Asked(renderer, frame), before);
  }
}

} // namespace test::proof
