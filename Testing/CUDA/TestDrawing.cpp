// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that the kernels draw through a cache on the device, against those of Core's renderer.
#include "Testing/CUDA/MarchedCases.h"
#include "Testing/CUDA/SmallCache.h"

#include <algorithm>
#include <tuple>

namespace {

class DrawingOf : public CaseInAPlace
{};

TEST_P(DrawingOf, GivesThePicturesOfTheCpu)
{
  const auto& [place, which] = GetParam();
  inr::Frame frame = PlainFrame();
  which.change(frame);
  const Drawn truth = Draw(frame, OptionsWith(nullptr));
  ASSERT_GT(*std::max_element(truth.rgba.pixels.begin(), truth.rgba.pixels.end()), 0.1f);
  const Drawn drawn = Draw(frame, OptionsWith(DeviceIn(place)));
  std::cout << inr::ImagePsnr(drawn.rgba, truth.rgba) << " dB\n";
  EXPECT_TRUE(drawn.statistics.accelerated);
  EXPECT_GE(inr::ImagePsnr(drawn.rgba, truth.rgba), 60);
  EXPECT_TRUE(drawn.statistics.complete);
  EXPECT_EQ(drawn.statistics.missed, 0);
  EXPECT_EQ(drawn.statistics.rays, truth.statistics.rays);
  EXPECT_EQ(drawn.statistics.levels.finest, truth.statistics.levels.finest);
  EXPECT_EQ(drawn.statistics.levels.coarsest, truth.statistics.levels.coarsest);
}

/// And what only a cache makes different.
std::vector<Case> Cases()
{
  std::vector<Case> cases = MarchedCases();
  cases.push_back({"FullResolution", [](inr::Frame& frame) { frame.levelOfDetailScale = 0; }});
  cases.push_back({"MixedLevels", [](inr::Frame& frame) { frame.levelOfDetailScale = 2.5; }});
  cases.push_back({"LayeredMixedLevels", [](inr::Frame& frame) {
                     frame.levelOfDetailScale = 2.5;
                     AddLayers(frame);
                   }});
  cases.push_back({"LitMixedLevels", [](inr::Frame& frame) {
                     frame.levelOfDetailScale = 2.5;
                     Shade(frame);
                   }});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Kernels, DrawingOf,
                         testing::Combine(testing::Values(Place::Host, Place::Gpu),
                                          testing::ValuesIn(Cases())),
                         CaseInAPlace::nameOf);

class Drawing : public InAPlace
{};

INSTANTIATE_TEST_SUITE_P(Kernels, Drawing, testing::Values(Place::Host, Place::Gpu),
                         InAPlace::nameOf);

TEST_P(Drawing, GivesDepthsAndSamplesToo)
{
  for (const bool layered : {false, true}) {
    inr::Frame frame = PlainFrame();
    if (layered) {
      AddLayers(frame);
    }
    const Drawn truth = Draw(frame, OptionsWith(nullptr));
    const Drawn drawn = Draw(frame, OptionsWith(DeviceIn(GetParam())));
    EXPECT_LT(LargestDifference(drawn.depth, truth.depth), 1e-4);
    // The CPU leaves out samples where the voxels around show nothing.
    for (std::size_t k = 0; k < truth.samples.pixels.size(); k += 2) {
      ASSERT_GE(drawn.samples.pixels[k], truth.samples.pixels[k]) << k;
    }
    EXPECT_EQ(drawn.statistics.samples, truth.statistics.samples + truth.statistics.hidden);
  }
}

/// Paths meet the same random numbers; a few may part ways for rounding.
TEST_P(Drawing, TracesThePathsOfTheCpu)
{
  for (const double scale : {0.0, 2.5}) {
    inr::Frame frame = PlainFrame();
    if (scale > 0) {
      AddLayers(frame);
    }
    frame.mode = inr::RenderMode::PathTracing;
    frame.samplesPerPixel = 3;
    frame.levelOfDetailScale = scale;
    frame.paths.ambientLight = glm::vec3(0.3f, 0.4f, 0.5f);
    frame.paths.anisotropy = 0.4;
    frame.clippingPlanes = {PlaneAcross({1, 0.3, -0.2})};
    frame.opaqueDepth = SomeDepth().data();
    LightUp(frame);
    const Drawn truth = Draw(frame, OptionsWith(nullptr));
    const Drawn drawn = Draw(frame, OptionsWith(DeviceIn(GetParam())));
    std::size_t others = 0;
    for (std::size_t k = 0; k < truth.rgba.pixels.size(); ++k) {
      others += std::abs(truth.rgba.pixels[k] - drawn.rgba.pixels[k]) > 1e-3f ? 1 : 0;
    }
    EXPECT_LT(others, truth.rgba.pixels.size() / 100);
    EXPECT_EQ(drawn.statistics.paths, 3);
    EXPECT_TRUE(drawn.statistics.complete);
    EXPECT_GT(drawn.statistics.work.scatterings, 100); // the CPU follows some paths twice
  }
}

/// Draws, but not for ever.
inr::Image DrawnInTheEnd(const inr::Frame& frame, const inr::RendererOptions& options)
{
  int asked = 0;
  const auto keepGoing = [&] { return ++asked < 20000; };
  inr::Renderer renderer = RendererOf(options);
  inr::Image image;
  EXPECT_TRUE(renderer.render(frame, image, nullptr, keepGoing).complete);
  EXPECT_FALSE(renderer.acceleratorFailure());
  return image;
}

/// Room for few bricks is enough for every picture; it only takes longer. In which order rays come
/// to wait decides which of them goes on, so that both orders are tried.
TEST_P(Drawing, NeedsNoMoreThanTheSmallestCache)
{
  HostLaunch backward;
  backward.backward = true;
  for (const auto& [mode, layered] : std::vector<std::pair<inr::RenderMode, bool>>{
           {Modes[0], false}, {Modes[0], true}, {Modes[1], false}}) {
    inr::Frame frame = FullResolution(mode);
    Shade(frame);
    if (layered) {
      AddLayers(frame);
    }
    const inr::Image truth = DrawnInTheEnd(frame, RoomFor(GetParam(), 0));
    for (const std::int64_t bricks : {8, 16}) {
      EXPECT_EQ(DrawnInTheEnd(frame, RoomFor(GetParam(), bricks)).pixels, truth.pixels) << bricks;
      EXPECT_EQ(DrawnInTheEnd(frame, RoomFor(GetParam(), bricks, backward)).pixels, truth.pixels)
          << bricks;
    }
  }
}

/// Where a ray waits for one of two bricks, it does not matter that it opens the other one anew.
TEST_P(Drawing, MixesLevelsTheSameWhereverItWaits)
{
  inr::Frame frame = SmallFrame(inr::RenderMode::RayMarching);
  frame.levelOfDetailScale = 2.5;
  const inr::Image truth = DrawnInTheEnd(frame, RoomFor(GetParam(), 0));
  EXPECT_EQ(DrawnInTheEnd(frame, RoomFor(GetParam(), 8)).pixels, truth.pixels);
  EXPECT_EQ(Draw(frame, RoomFor(GetParam(), 0)).rgba.pixels, truth.pixels);
}

TEST_P(Drawing, ComesToTheSamePictureInTime)
{
  for (const bool deterministic : {true, false}) {
    for (const std::int64_t bricks : {0, 20}) {
      for (const inr::RenderMode mode : Modes) {
        inr::Frame frame = FullResolution(mode);
        inr::RendererOptions options = RoomFor(GetParam(), bricks);
        options.cache.maximumRequests = 15;
        options.deterministic = deterministic;
        const Drawn truth = Draw(frame, options);
        inr::Renderer renderer = RendererOf(options);
        frame.timeLimit = 1e-3;
        int calls = 0;
        EXPECT_EQ(Finish(renderer, frame, calls).pixels, truth.rgba.pixels)
            << deterministic << " " << bricks << " " << static_cast<int>(mode);
        EXPECT_GT(calls, 1);
        EXPECT_LT(calls, 1000);
      }
    }
  }
}

/// Rays of projections begin a step in front of the volume, where their first brick may not be
/// there yet.
TEST_P(Drawing, CountsRaysThatWaitAtOnceOnlyOnce)
{
  inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  Projected(inr::BlendMode::MaximumIntensity)(frame);
  const Drawn truth = Draw(frame, RoomFor(GetParam(), 0));
  const Drawn waiting = Draw(frame, RoomFor(GetParam(), 20));
  EXPECT_EQ(waiting.rgba.pixels, truth.rgba.pixels);
  EXPECT_EQ(waiting.statistics.rays, truth.statistics.rays);
}

TEST_P(Drawing, MakesDoWithWhatFits)
{
  inr::RendererOptions options = RoomFor(GetParam(), 20);
  options.cache.onlyWhatFits = true;
  for (const inr::RenderMode mode : Modes) {
    const Drawn drawn = Draw(FullResolution(mode), options);
    EXPECT_TRUE(drawn.statistics.complete);
    EXPECT_GT(drawn.statistics.levels.coarsest, 0);
    EXPECT_GT(drawn.statistics.samples, 0);
  }
}

/// In which order threads come makes no difference, nor how many there are.
TEST(DrawingOnTheHost, DoesNotDependOnTheOrderOfThreads)
{
  inr::Frame frame = PlainFrame();
  frame.levelOfDetailScale = 2.5;
  HostLaunch backward;
  backward.backward = true;
  HostLaunch few;
  few.blocks = 1;
  for (const inr::RenderMode mode : Modes) {
    frame.mode = mode;
    frame.samplesPerPixel = 1;
    const Drawn forward = Draw(frame, OptionsWith(Device()));
    EXPECT_EQ(Draw(frame, OptionsWith(Device(backward))).rgba.pixels, forward.rgba.pixels);
    EXPECT_EQ(Draw(frame, OptionsWith(Device(few))).rgba.pixels, forward.rgba.pixels);
  }
}

} // namespace
