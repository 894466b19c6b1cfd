// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that the kernels draw through a cache on the device, against those of Core's renderer.
#include "CUDA/Render/DeviceLayers.h"
#include "Testing/CUDA/MarchedCases.h"
#include "Testing/CUDA/SmallCache.h"

#include <algorithm>
#include <atomic>
#include <set>
#include <tuple>

namespace test::drawing {

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
  // Rounding may take a ray past the rim of a surface.
  if (frame.blending.mode == inr::BlendMode::Isosurface && place == Place::Gpu) {
    EXPECT_LT(Others(drawn.rgba, truth.rgba, 1e-3f), 0.01);
  } else {
    EXPECT_GE(inr::ImagePsnr(drawn.rgba, truth.rgba), 60);
  }
  EXPECT_TRUE(drawn.statistics.complete);
  EXPECT_EQ(drawn.statistics.missed, 0);
  EXPECT_EQ(drawn.statistics.rays, truth.statistics.rays);
  EXPECT_EQ(drawn.statistics.levels.finest, truth.statistics.levels.finest);
  EXPECT_EQ(drawn.statistics.levels.coarsest, truth.statistics.levels.coarsest);
}

/// A Case's name, which it does not keep.
const char* KeptName(const std::string& name)
{
  static std::set<std::string> names;
  return names.insert(name).first->c_str();
}

/// And what only a cache makes different.
std::vector<Case> Cases()
{
  std::vector<Case> cases = MarchedCases();
  cases.push_back({"FullResolution", [](inr::Frame& frame) { frame.levelOfDetailScale = 0; }});
  cases.push_back({"MixedLevels", [](inr::Frame& frame) { frame.levelOfDetailScale = 2.5; }});
  const auto integrated = [](inr::Frame& frame) { frame.preIntegration = true; };
  const std::vector<std::pair<std::string, std::function<void(inr::Frame&)>>> ends = {
      {"Surfaces", ShowSurfaces}, {"Integrated", integrated}};
  for (const auto& [name, look] : ends) {
    for (const Case& more : MarchedCases()) {
      const std::string other = more.name;
      if (other.find("Lit") != std::string::npos || other == "Plain" || other == "Cropped" ||
          other == "Piece" || other == "Layered" || other == "BehindSomething") {
        cases.push_back({KeptName(name + other), [look = look, more](inr::Frame& frame) {
                           more.change(frame);
                           look(frame);
                         }});
      }
    }
    cases.push_back({KeptName(name + "MixedLevels"), [look = look](inr::Frame& frame) {
                       look(frame);
                       frame.levelOfDetailScale = 2.5;
                     }});
  }
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
  const auto integrated = [](inr::Frame& frame) { frame.preIntegration = true; };
  for (const Case& kind : {Case{"Plain", [](inr::Frame&) {}}, Case{"Layered", AddLayers},
                           Case{"Surfaces", ShowSurfaces}, Case{"Integrated", integrated}}) {
    SCOPED_TRACE(kind.name);
    inr::Frame frame = PlainFrame();
    kind.change(frame);
    const Drawn truth = Draw(frame, OptionsWith(nullptr));
    const Drawn drawn = Draw(frame, OptionsWith(DeviceIn(GetParam())));
    EXPECT_LT(Others(drawn.depth, truth.depth, 1e-4f), GetParam() == Place::Gpu ? 0.01 : 1e-9);
    if (frame.preIntegration || frame.blending.mode == inr::BlendMode::Isosurface) {
      continue; // the CPU leaves out other samples there
    }
    // The CPU leaves out samples where the voxels around show nothing.
    for (std::size_t k = 0; k < truth.samples.pixels.size(); k += 2) {
      ASSERT_GE(drawn.samples.pixels[k], truth.samples.pixels[k]) << k;
    }
    EXPECT_EQ(drawn.statistics.samples, truth.statistics.samples + truth.statistics.hidden);
  }
}

/// Each kind has memory of its own; and of layers, the latest ones count.
TEST_P(Drawing, GoesFromOneKindToAnother)
{
  const auto others = [](inr::Frame& frame) {
    AddLayers(frame);
    auto changed = std::make_shared<inr::TranslucentLayers>(*frame.layers);
    changed->layers.pop_back();
    for (glm::vec4& color : changed->layers.front().colors) {
      color *= 0.5f;
    }
    frame.layers = changed;
  };
  const auto paths = [](inr::Frame& frame) {
    AddLayers(frame);
    frame.mode = inr::RenderMode::PathTracing;
  };
  inr::Renderer renderer = RendererOf(OptionsWith(DeviceIn(GetParam())));
  for (const Case& kind :
       {Case{"Layered", AddLayers}, Case{"Others", others}, Case{"Plain", [](inr::Frame&) {}},
        Case{"Surfaces", ShowSurfaces}, Case{"Paths", paths}, Case{"LayeredAgain", AddLayers},
        Case{"PathsAgain", paths}}) {
    SCOPED_TRACE(kind.name);
    inr::Frame frame = SmallFrame(inr::RenderMode::RayMarching);
    kind.change(frame);
    inr::Image image;
    EXPECT_TRUE(renderer.render(frame, image).accelerated);
    EXPECT_EQ(image.pixels, Draw(frame, OptionsWith(DeviceIn(GetParam()))).rgba.pixels);
  }
}

TEST(DrawingOfLayers, IsLeftToTheCpuWhereTheyAreMany)
{
  inr::Frame frame;
  frame.width = frame.height = 2048;
  auto layers = std::make_shared<inr::TranslucentLayers>();
  frame.layers = layers;
  for (int count = 0; count <= 4; ++count) {
    EXPECT_EQ(inr::cuda::TakesLayersOf(frame), count <= 3) << count; // of 80 MiB each
    layers->layers.emplace_back();
  }
}

/// Paths meet the same random numbers; a few may part ways for rounding.
TEST_P(Drawing, TracesThePathsOfTheCpu)
{
  for (const auto& [scale, layered] :
       std::vector<std::pair<double, bool>>{{0.0, false}, {2.5, false}, {2.5, true}}) {
    inr::Frame frame = PlainFrame();
    if (layered) {
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
Drawn DrawnInTheEnd(const inr::Frame& frame, const inr::RendererOptions& options)
{
  std::atomic<int> asked{0};
  const auto keepGoing = [&] { return ++asked < 20000; };
  inr::Renderer renderer = RendererOf(options);
  Drawn drawn;
  drawn.statistics = renderer.render(frame, drawn.rgba, &drawn.depth, keepGoing);
  EXPECT_TRUE(drawn.statistics.complete);
  EXPECT_TRUE(drawn.statistics.accelerated);
  EXPECT_FALSE(renderer.acceleratorFailure());
  return drawn;
}

void ExpectSame(const Drawn& drawn, const Drawn& truth)
{
  EXPECT_EQ(drawn.rgba.pixels, truth.rgba.pixels);
  EXPECT_EQ(drawn.depth.pixels, truth.depth.pixels);
}

/// Kinds of frames whose rays remember different things while they wait.
std::vector<Case> WaitingCases()
{
  return {{"Lit", Shade},
          {"Layered", AddLayers},
          {"LitLayered",
           [](inr::Frame& frame) {
             Shade(frame);
             AddLayers(frame);
           }},
          {"Surfaces",
           [](inr::Frame& frame) {
             Shade(frame);
             ShowSurfaces(frame);
           }},
          {"Integrated",
           [](inr::Frame& frame) {
             Shade(frame);
             frame.preIntegration = true;
           }},
          {"SurfacesBetweenFew", // samples, so that what is looked at may be bricks away
           [](inr::Frame& frame) {
             Shade(frame);
             ShowSurfaces(frame);
             frame.sampleDistance = 6;
           }},
          {"LayeredSurfaces",
           [](inr::Frame& frame) {
             AddLayers(frame);
             ShowSurfaces(frame);
           }},
          {"Paths",
           [](inr::Frame& frame) {
             Shade(frame);
             frame.mode = inr::RenderMode::PathTracing;
           }},
          {"LayeredPaths", [](inr::Frame& frame) {
             Shade(frame);
             AddLayers(frame);
             frame.mode = inr::RenderMode::PathTracing;
           }}};
}

class WaitingFor : public CaseInAPlace
{};

/// Room for few bricks is enough for every picture; it only takes longer. In which order rays come
/// to wait decides which of them goes on, so that both orders are tried.
TEST_P(WaitingFor, NeedsNoMoreThanTheSmallestCache)
{
  const auto& [place, which] = GetParam();
  HostLaunch backward;
  backward.backward = true;
  inr::Frame frame = FullResolution(inr::RenderMode::RayMarching);
  which.change(frame);
  const Drawn truth = DrawnInTheEnd(frame, RoomFor(place, 0));
  for (const std::int64_t bricks : {8, 16}) {
    SCOPED_TRACE(bricks);
    ExpectSame(DrawnInTheEnd(frame, RoomFor(place, bricks)), truth);
    ExpectSame(DrawnInTheEnd(frame, RoomFor(place, bricks, backward)), truth);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, WaitingFor,
                         testing::Combine(testing::Values(Place::Host, Place::Gpu),
                                          testing::ValuesIn(WaitingCases())),
                         CaseInAPlace::nameOf);

/// Where a ray waits for one of two bricks, it does not matter that it opens the other one anew.
TEST_P(Drawing, MixesLevelsTheSameWhereverItWaits)
{
  inr::Frame frame = SmallFrame(inr::RenderMode::RayMarching);
  frame.levelOfDetailScale = 2.5;
  const Drawn truth = DrawnInTheEnd(frame, RoomFor(GetParam(), 0));
  ExpectSame(DrawnInTheEnd(frame, RoomFor(GetParam(), 8)), truth);
  EXPECT_EQ(Draw(frame, RoomFor(GetParam(), 0)).rgba.pixels, truth.rgba.pixels);
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

} // namespace test::drawing
