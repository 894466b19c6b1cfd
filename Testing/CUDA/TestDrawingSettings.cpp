// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that kernels draw through the cache with whatever a renderer may be set to, against
// those of Core's renderer.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/DrawingScene.h"

namespace test::drawing_settings {

class DrawingSettings : public InAPlace
{
protected:
  inr::RendererOptions options() const { return OptionsWith(DeviceIn(GetParam())); }
};

INSTANTIATE_TEST_SUITE_P(Kernels, DrawingSettings, testing::Values(Place::Host, Place::Gpu),
                         InAPlace::nameOf);

/// A few paths part ways for rounding.
void ExpectAlike(const inr::Image& drawn, const inr::Image& truth, inr::RenderMode mode)
{
  if (mode == inr::RenderMode::RayMarching) {
    EXPECT_GE(inr::ImagePsnr(drawn, truth), 60);
    return;
  }
  std::size_t others = 0;
  for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
    others += std::abs(truth.pixels[k] - drawn.pixels[k]) <= 1e-3f ? 0 : 1;
  }
  EXPECT_LE(others, truth.pixels.size() / 100);
}

void ExpectAbout(std::int64_t drawn, std::int64_t truth)
{
  EXPECT_NEAR(static_cast<double>(drawn), static_cast<double>(truth),
              0.02 * static_cast<double>(truth) + 2);
}

TEST_P(DrawingSettings, EveryPrecisionOfTheCacheGivesThePicturesOfTheCpu)
{
  for (const inr::CachePrecision precision :
       {inr::CachePrecision::Float32, inr::CachePrecision::Bits16, inr::CachePrecision::Bits8}) {
    for (const inr::RenderMode mode : Modes) {
      SCOPED_TRACE(static_cast<int>(precision));
      inr::RendererOptions options = this->options();
      options.cache.precision = precision;
      const Drawn drawn = Draw(FullResolution(mode), options);
      EXPECT_TRUE(drawn.statistics.accelerated);
      options.accelerator = nullptr;
      ExpectAlike(drawn.rgba, Draw(FullResolution(mode), options).rgba, mode);
    }
  }
}

/// Where colours are steep and opaque, rounding of voxels shows, and is the same.
TEST_P(DrawingSettings, RoundsWhatItKeepsAsTheCpuDoes)
{
  inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
  for (std::size_t k = 0; k < colours.table.size(); ++k) {
    colours.table[k].w = k < colours.table.size() / 2 ? 0.0f : 1.0f;
  }
  const inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  inr::RendererOptions options = this->options();
  const auto drawnWith = [&](inr::CachePrecision precision) {
    options.cache.precision = precision;
    inr::Renderer renderer = RendererOf(options);
    renderer.setTransferFunction(colours);
    inr::Image image;
    renderer.render(frame, image);
    return image;
  };
  const inr::Image drawn = drawnWith(inr::CachePrecision::Bits8);
  options.accelerator = nullptr;
  EXPECT_GE(inr::ImagePsnr(drawn, drawnWith(inr::CachePrecision::Bits8)), 90);
  EXPECT_LE(inr::ImagePsnr(drawn, drawnWith(inr::CachePrecision::Float32)), 60);
}

TEST_P(DrawingSettings, WhatIsOpaqueAtOneValueIsSteepAsByTheCpu)
{
  inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
  for (std::size_t k = 1; k + 1 < colours.table.size(); k += 2) {
    colours.table[k].w = 1;
    colours.table[k + 1].w = 0;
  }
  inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  frame.unitDistance *= 100;
  inr::RendererOptions options = this->options();
  const auto drawn = [&] {
    inr::Renderer renderer = RendererOf(options);
    renderer.setTransferFunction(colours);
    inr::Image image;
    EXPECT_EQ(renderer.render(frame, image).accelerated, options.accelerator != nullptr);
    return image;
  };
  const inr::Image picture = drawn();
  options.accelerator = nullptr;
  EXPECT_GE(inr::ImagePsnr(picture, drawn()), 60);
}

/// Colours over the logarithm of values.
inr::TransferFunction Logarithmic()
{
  inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
  colours.low = 0.02 * colours.high;
  colours.logarithmic = true;
  return colours;
}

TEST_P(DrawingSettings, LogarithmicColoursGiveThePicturesOfTheCpu)
{
  ASSERT_GT(Logarithmic().low, 0);
  for (const inr::RenderMode mode : Modes) {
    for (const bool lit : {false, true}) {
      inr::Frame frame = FullResolution(mode);
      if (lit) {
        Shade(frame);
      }
      inr::Image pictures[2];
      for (const bool accelerated : {false, true}) {
        inr::Renderer renderer = RendererOf(accelerated ? this->options() : OptionsWith(nullptr));
        renderer.setTransferFunction(Logarithmic());
        EXPECT_EQ(renderer.render(frame, pictures[accelerated]).accelerated, accelerated);
      }
      ExpectAlike(pictures[1], pictures[0], mode);
      EXPECT_LT(inr::ImagePsnr(pictures[0], Draw(frame, OptionsWith(nullptr)).rgba), 40);
    }
  }
}

/// Frames of other sizes, colours and lengths of samples, one after another by the same renderer.
TEST_P(DrawingSettings, OfFramesBeforeNothingIsLeft)
{
  inr::Renderer renderer = RendererOf(this->options());
  inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
  for (const inr::RenderMode mode : {Modes[0], Modes[1], Modes[0]}) {
    for (const int width : {6, 24, 9}) {
      SCOPED_TRACE(width);
      for (glm::vec4& color : colours.table) {
        color = {color.y, color.z, color.x, 0.9f * color.w};
      }
      inr::Frame frame = FullResolution(mode);
      frame.width = width;
      frame.sampleDistance = width == 9 ? 0.4 : 0.7;
      const auto drawnBy = [&](inr::Renderer& one) {
        one.setTransferFunction(colours);
        inr::Image image;
        EXPECT_TRUE(one.render(frame, image).accelerated);
        return image;
      };
      inr::Renderer fresh = RendererOf(this->options());
      EXPECT_EQ(drawnBy(renderer).pixels, drawnBy(fresh).pixels);
    }
  }
}

/// Where opacity comes to one half, or where what is projected is.
TEST_P(DrawingSettings, DepthsAreThoseOfTheCpu)
{
  for (const inr::BlendMode mode :
       {inr::BlendMode::Composite, inr::BlendMode::MaximumIntensity,
        inr::BlendMode::MinimumIntensity, inr::BlendMode::AverageIntensity}) {
    SCOPED_TRACE(static_cast<int>(mode));
    inr::RendererOptions options = this->options();
    inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
    frame.blending.mode = mode;
    frame.unitDistance = 0.2;
    inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
    if (mode == inr::BlendMode::MaximumIntensity || mode == inr::BlendMode::MinimumIntensity) {
      for (glm::vec4& color : colours.table) {
        color.w = color.x < 0.3f ? 0.1f : 0.8f;
      }
    }
    inr::Image depths[2];
    for (const bool accelerated : {false, true}) {
      inr::Renderer renderer = RendererOf(accelerated ? options : OptionsWith(nullptr));
      renderer.setTransferFunction(colours);
      inr::Image image;
      renderer.render(frame, image, &depths[accelerated]);
    }
    std::size_t others = 0;
    std::size_t near = 0;
    for (std::size_t k = 0; k < depths[0].pixels.size(); ++k) {
      others += std::abs(depths[0].pixels[k] - depths[1].pixels[k]) <= 1e-4f ? 0 : 1;
      near += depths[0].pixels[k] < 1.0f ? 1 : 0;
    }
    EXPECT_LE(others, depths[0].pixels.size() / 100);
    EXPECT_EQ(near > 0, mode != inr::BlendMode::AverageIntensity) << "nothing was compared";
  }
}

TEST_P(DrawingSettings, ValuesOutsideTheirRangesAreMovedAsByTheCpu)
{
  const inr::ModelPointer model = WithNarrowRanges();
  inr::TransferFunction colours = ColoursOf(model->volume);
  for (glm::vec4& color : colours.table) { // so that the CPU leaves out nothing
    color.w = 0.1f + 0.1f * color.x;
  }
  for (const inr::RenderMode mode : Modes) {
    inr::Image pictures[2];
    std::int64_t clamped[2];
    for (const bool accelerated : {false, true}) {
      inr::Renderer renderer(model, accelerated ? this->options() : OptionsWith(nullptr));
      renderer.setTransferFunction(colours);
      inr::Frame frame = FullResolution(mode);
      frame.width = 24; // more values
      const inr::FrameStatistics statistics = renderer.render(frame, pictures[accelerated]);
      EXPECT_EQ(statistics.accelerated, accelerated);
      clamped[accelerated] = statistics.clamped;
    }
    ExpectAlike(pictures[1], pictures[0], mode);
    EXPECT_GT(clamped[0], 50);
    // The CPU counts some less of rays that end.
    EXPECT_GE(clamped[1], clamped[0] - 2);
    EXPECT_LE(clamped[1], clamped[0] + clamped[0] / 8);
  }
}

/// What the statistics of paths and rays say, too.
TEST_P(DrawingSettings, CountsAreThoseOfTheCpu)
{
  inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  frame.levelOfDetailScale = 2.5;
  const Drawn marched = Draw(frame, this->options());
  const Drawn truth = Draw(frame, OptionsWith(nullptr));
  EXPECT_EQ(marched.statistics.levels.finest, truth.statistics.levels.finest);
  EXPECT_EQ(marched.statistics.levels.coarsest, truth.statistics.levels.coarsest);
  ExpectAbout(marched.statistics.clamped, truth.statistics.clamped);
  std::size_t others = 0;
  for (std::size_t k = 0; k < truth.samples.pixels.size(); k += 2) { // none is left out there
    const bool all = truth.samples.pixels[k] == marched.samples.pixels[k];
    others += all && std::abs(truth.samples.pixels[k + 1] - marched.samples.pixels[k + 1]) > 1e-3f;
  }
  EXPECT_EQ(others, 0u);

  Shade(frame);
  ExpectAbout(Draw(frame, this->options()).statistics.work.gradients,
              Draw(frame, OptionsWith(nullptr)).statistics.work.gradients);

  frame.shading.reset();
  frame.mode = inr::RenderMode::PathTracing;
  frame.paths.ambientLight = glm::vec3(0.3f);
  const Drawn traced = Draw(frame, this->options());
  const Drawn paths = Draw(frame, OptionsWith(nullptr));
  EXPECT_EQ(traced.statistics.rays, paths.statistics.rays);
  ExpectAbout(traced.statistics.samples, paths.statistics.samples);
  EXPECT_GT(traced.statistics.work.lightSteps, 0);
  EXPECT_LT(traced.statistics.work.lightSteps, traced.statistics.samples);
}

} // namespace test::drawing_settings
