// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that want more bricks than their cache on the device holds, in a limited time: they come
// piece by piece, over several calls.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/OverfullFrames.h"

#include <array>
#include <atomic>
#include <vector>

namespace test::overfull_drawing {

using namespace overfull;

class OverfullDrawing : public InAPlace
{};

INSTANTIATE_TEST_SUITE_P(Kernels, OverfullDrawing, testing::Values(Place::Host, Place::Gpu),
                         InAPlace::nameOf);

/// Every sample is taken once, and what is finished is final.
TEST_P(OverfullDrawing, GoesOnWithTheSameRays)
{
  inr::Frame surfaces = LitFrame(inr::RenderMode::RayMarching);
  ShowSurfaces(surfaces);
  inr::Frame integrated = LitFrame(inr::RenderMode::RayMarching);
  integrated.preIntegration = true;
  for (const inr::Frame& frame : {FullResolution(inr::RenderMode::RayMarching),
                                  LitFrame(inr::RenderMode::RayMarching), surfaces, integrated}) {
    const Drawn truth = Draw(frame, RoomFor(GetParam(), 0));
    inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
    inr::Image image;
    inr::FrameStatistics now = Begin(renderer, Hurried(frame), image);
    std::int64_t gradients = now.work.gradients;
    int calls = 1;
    for (; !now.complete && calls < MostCalls; ++calls) {
      const inr::Image before = image;
      const std::int64_t samples = now.samples;
      now = renderer.render(Hurried(frame), image);
      gradients += now.work.gradients;
      EXPECT_GE(now.samples, samples);
      EXPECT_LE(now.rays, truth.statistics.rays);
      EXPECT_EQ(PixelsInBetween(image, before, truth.rgba), 0);
    }
    EXPECT_GT(calls, 5);
    EXPECT_TRUE(now.complete);
    EXPECT_EQ(image.pixels, truth.rgba.pixels);
    EXPECT_EQ(now.samples, truth.statistics.samples);
    EXPECT_EQ(now.rays, truth.statistics.rays);
    EXPECT_EQ(gradients, truth.statistics.work.gradients);
  }
}

TEST_P(OverfullDrawing, EndsAtOnceWithoutALimit)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = FullResolution(mode);
    const Drawn truth = Draw(frame, RoomFor(GetParam(), 0));
    inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
    DrawSome(renderer, Hurried(frame));
    inr::Image image;
    EXPECT_TRUE(renderer.render(frame, image).complete);
    EXPECT_EQ(image.pixels, truth.rgba.pixels);
  }
}

/// Of which a step crosses several, each lit by bricks around it.
TEST_P(OverfullDrawing, GoesOnBetweenTheSurfacesOfAStep)
{
  inr::Frame frame = LitFrame(inr::RenderMode::RayMarching);
  const inr::VolumeInfo& volume = TrainedModel()->volume;
  frame.sampleDistance = 25; // several bricks
  frame.blending.mode = inr::BlendMode::Isosurface;
  for (double value = 0.55; value < 0.75; value += 0.02) { // where colours are translucent
    frame.blending.isosurfaces.push_back(volume.low + value * (volume.high - volume.low));
  }
  const Drawn truth = Draw(frame, RoomFor(GetParam(), 0));
  inr::Renderer renderer = RendererOf(RoomFor(GetParam(), inr::BrickCache::FewestBricks));
  inr::Image image;
  std::atomic<int> asked{0};
  renderer.render(frame, image, nullptr, [&] { return ++asked < 1000000; });
  EXPECT_EQ(image.pixels, truth.rgba.pixels);
  EXPECT_FALSE(renderer.acceleratorFailure());
}

TEST_P(OverfullDrawing, BeginsAnewForOtherPicturesAndColours)
{
  for (const inr::RenderMode mode : Modes) {
    inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
    inr::Image image;
    DrawSome(renderer, Hurried(FullResolution(mode)));
    End(renderer, Hurried(OtherFrame(mode)), image);
    EXPECT_EQ(image.pixels, Draw(OtherFrame(mode), RoomFor(GetParam(), 0)).rgba.pixels);

    DrawSome(renderer, Hurried(FullResolution(mode)));
    inr::TransferFunction colours = ColoursOf(TrainedModel()->volume);
    for (glm::vec4& color : colours.table) {
      std::swap(color.x, color.z);
    }
    renderer.setTransferFunction(colours);
    End(renderer, Hurried(FullResolution(mode)), image);
    inr::Renderer whole = RendererOf(RoomFor(GetParam(), 0));
    whole.setTransferFunction(colours);
    inr::Image truth;
    whole.render(FullResolution(mode), truth);
    EXPECT_EQ(image.pixels, truth.pixels);
  }
}

/// Those that are drawn without a limit are not what somebody looks at: the small ones that prove
/// a kind of pictures, for one.
TEST_P(OverfullDrawing, GoesOnBehindAPictureInBetween)
{
  const inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  inr::Frame small = OtherFrame(inr::RenderMode::RayMarching);
  small.width = small.height = 8;
  const Drawn truth = Draw(frame, RoomFor(GetParam(), 0));
  const Drawn smallTruth = Draw(small, RoomFor(GetParam(), 0));
  inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
  inr::Image image;
  std::int64_t samples = Begin(renderer, Hurried(frame), image).samples;
  inr::FrameStatistics now;
  for (int calls = 0; !now.complete || calls == 0; ++calls) {
    ASSERT_LT(calls, MostCalls);
    renderer.render(small, image);
    EXPECT_EQ(image.pixels, smallTruth.rgba.pixels);
    now = renderer.render(Hurried(frame), image);
    EXPECT_GE(now.samples, samples);
    samples = now.samples;
  }
  EXPECT_EQ(image.pixels, truth.rgba.pixels);
  EXPECT_EQ(now.samples, truth.statistics.samples);
}

/// Two views that a window draws by turns until each has its picture; and one that is left alone.
TEST_P(OverfullDrawing, ComesToItsEndForOneViewAfterAnother)
{
  std::array<inr::Frame, 2> frames{FullResolution(inr::RenderMode::RayMarching),
                                   OtherFrame(inr::RenderMode::RayMarching)};
  frames[1].view = 1;
  inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
  std::array<inr::Image, 2> shown;
  std::array<bool, 2> complete{};
  for (int turns = 0; !complete[0] || !complete[1]; ++turns) {
    ASSERT_LT(turns, MostCalls);
    for (std::size_t k = 0; k < 2; ++k) {
      complete[k] = complete[k] || renderer.render(Hurried(frames[k]), shown[k]).complete;
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(shown[k].pixels, Draw(frames[k], RoomFor(GetParam(), 0)).rgba.pixels) << k;
  }
  frames[0].clipToWorld[1][1] *= 1.1; // begins anew, and is shown no more
  Begin(renderer, Hurried(frames[0]), shown[0]);
  frames[1].clipToWorld[1][1] *= 1.1;
  End(renderer, Hurried(frames[1]), shown[1]);
  EXPECT_EQ(shown[1].pixels, Draw(frames[1], RoomFor(GetParam(), 0)).rgba.pixels);
}

/// Paths of two views by turns.
class PathsOfTwoViews : public InAPlace
{
protected:
  PathsOfTwoViews()
  {
    for (inr::Frame& frame : this->frames) {
      frame.width = 40;
      frame.height = 30;
      frame.paths.ambientLight = glm::vec3(1.0f);
      frame.samplesPerPixel = 2;
    }
    this->frames[1].clipToWorld[0][0] *= 1.6;
    this->frames[1].clipToWorld[1][1] *= 1.6;
    this->frames[1].seed = 5;
    this->frames[1].view = 1;
  }

  std::array<inr::Frame, 2> frames{FullResolution(inr::RenderMode::PathTracing),
                                   FullResolution(inr::RenderMode::PathTracing)};
  std::array<inr::Image, 2> shown;
};

INSTANTIATE_TEST_SUITE_P(Kernels, PathsOfTwoViews, testing::Values(Place::Host, Place::Gpu),
                         InAPlace::nameOf);

TEST_P(PathsOfTwoViews, ShowNothingOfEachOther)
{
  inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
  for (int call = 0; call < 12; ++call) {
    const std::size_t k = call % 2;
    renderer.render(Hurried(this->frames[k]), this->shown[k]);
    if (call > 0) {
      EXPECT_EQ(PixelsOfBoth(this->shown[0], this->shown[1]), 0) << call;
    }
  }
  // Once without a limit, but stopped, when the paths of some tiles have ended.
  std::atomic<int> asked{0};
  EXPECT_THROW(
      renderer.render(this->frames[0], this->shown[0], nullptr, [&] { return ++asked < 4; }),
      inr::Error);
  renderer.render(Hurried(this->frames[0]), this->shown[0]);
  EXPECT_EQ(PixelsOfBoth(this->shown[0], this->shown[1]), 0);
}

/// Whose calls do not go by the clock, and take a sample to its end.
TEST_P(PathsOfTwoViews, ComeToTheirEndsWhereTheyAreDeterministic)
{
  inr::RendererOptions options = RoomFor(GetParam(), 20);
  options.deterministic = true;
  inr::Renderer renderer = RendererOf(options);
  std::array<bool, 2> complete{};
  for (int turns = 0; !complete[0] || !complete[1]; ++turns) {
    ASSERT_LT(turns, 20);
    for (std::size_t k = 0; k < 2; ++k) {
      complete[k] = renderer.render(Hurried(this->frames[k]), this->shown[k]).complete;
    }
  }
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(this->shown[k].pixels, Draw(this->frames[k], RoomFor(GetParam(), 0)).rgba.pixels)
        << k;
  }
}

/// Whose samples are as far apart as those of no other: what is made of colours for them goes.
TEST_P(OverfullDrawing, BeginsAnewBehindOneOfOtherDistances)
{
  const inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  inr::Frame small = OtherFrame(inr::RenderMode::RayMarching);
  small.width = small.height = 8;
  small.sampleDistance = 0.5;
  inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
  inr::Image image;
  Begin(renderer, Hurried(frame), image);
  DrawSome(renderer, Hurried(frame));
  renderer.render(small, image);
  End(renderer, Hurried(frame), image);
  EXPECT_EQ(image.pixels, Draw(frame, RoomFor(GetParam(), 0)).rgba.pixels);
}

TEST_P(OverfullDrawing, GoesOnWhenItWasStopped)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = FullResolution(mode);
    inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
    DrawSome(renderer, Hurried(frame));
    inr::Image image;
    for (int call = 0; call < 3; ++call) {
      renderer.render(Hurried(frame), image);
      std::atomic<int> asked{0};
      const auto stopAfterOne = [&] { return asked++ < 1; };
      EXPECT_THROW(renderer.render(frame, image, nullptr, stopAfterOne), inr::Error) << call;
    }
    End(renderer, Hurried(frame), image);
    EXPECT_EQ(image.pixels, Draw(frame, RoomFor(GetParam(), 0)).rgba.pixels);
  }
}

/// Paths that nobody waited for any longer, when nothing was known of the cache's size.
TEST_P(OverfullDrawing, GoesOnInTimeWithWhatWasStopped)
{
  inr::Frame frame = FullResolution(inr::RenderMode::PathTracing);
  frame.samplesPerPixel = 3;
  const Drawn truth = Draw(frame, RoomFor(GetParam(), 0));
  for (int most = 1; most < 100; most += 13) {
    inr::Renderer renderer = RendererOf(RoomFor(GetParam(), 20));
    inr::Image image;
    std::atomic<int> asked{0};
    const auto stopAfterSome = [&] { return asked++ < most; };
    EXPECT_THROW(renderer.render(frame, image, nullptr, stopAfterSome), inr::Error) << most;
    End(renderer, Hurried(frame), image);
    EXPECT_EQ(image.pixels, truth.rgba.pixels) << most;
  }
}

} // namespace test::overfull_drawing
