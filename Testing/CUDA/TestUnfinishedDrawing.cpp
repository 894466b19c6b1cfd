// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that a device hands over before all bricks are there: what is shown instead, what is
// asked for, and what is said of it.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/DrawingScene.h"

namespace test::unfinished_drawing {

constexpr double NoTime = 1e-9; // seconds: one pass

/// Small bricks, all of which have room; what comes in comes within the frame.
inr::RendererOptions SmallBricks(bool preloading)
{
  inr::RendererOptions options = OptionsWith(Device());
  options.cache.brickSize = 5;
  options.cache.maximumRequests = 1 << 20;
  options.cache.background = false;
  options.cache.preloading = preloading;
  return options;
}

inr::Frame FrameAt(double scale, inr::RenderMode mode = inr::RenderMode::RayMarching)
{
  inr::Frame frame = PlainFrame();
  frame.mode = mode;
  frame.width = 24;
  frame.height = 18;
  frame.samplesPerPixel = 1;
  frame.levelOfDetailScale = scale;
  frame.adaptiveSampling = false;
  return frame;
}

constexpr double Coarsest = 1e9; // scale

/// Has nothing but the coarsest brick, and is proven.
inr::Image Begin(inr::Renderer& renderer, const inr::Frame& coarse)
{
  inr::Image image;
  const inr::FrameStatistics statistics = renderer.render(coarse, image);
  EXPECT_TRUE(statistics.accelerated);
  EXPECT_EQ(statistics.levels.finest, statistics.levels.coarsest);
  EXPECT_EQ(renderer.cachedBricks(), 2); // the CPU's, and the device's
  return image;
}

/// So that nothing that a frame does not write is right by what was there before.
void Blank(inr::Renderer& renderer, inr::Frame frame)
{
  frame.clippingPlanes = {{1, 0, 0, -1e6}};
  inr::Image image;
  renderer.render(frame, image);
  EXPECT_EQ(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.0f);
}

/// Where only the coarsest brick is there, the picture is the one that asks for that: of rays that
/// have few samples, and many, of which they take some at a time.
TEST(UnfinishedDrawing, ShowsWhatIsThere)
{
  for (const Case& kind :
       {Case{"Plain", [](inr::Frame&) {}}, Case{"Lit", Shade}, Case{"Layered", AddLayers},
        Case{"Integrated", [](inr::Frame& frame) { frame.preIntegration = true; }}}) {
    for (const double distance : {0.7, 0.05}) {
      SCOPED_TRACE(kind.name);
      SCOPED_TRACE(distance);
      const auto with = [&](inr::Frame frame) {
        frame.sampleDistance = distance;
        kind.change(frame);
        return frame;
      };
      inr::Renderer renderer = RendererOf(SmallBricks(true));
      const inr::Image coarse = Begin(renderer, with(FrameAt(Coarsest)));
      Blank(renderer, with(FrameAt(Coarsest)));
      inr::Frame frame = with(FrameAt(0));
      frame.timeLimit = NoTime;
      inr::Image image;
      const inr::FrameStatistics first = renderer.render(frame, image);
      EXPECT_FALSE(first.complete);
      EXPECT_EQ(first.missed, first.samples);
      EXPECT_EQ(first.levels.finest, first.levels.coarsest);
      // Fewer samples are left out as nothing can be seen there.
      const inr::Image fine = Draw(with(FrameAt(0)), SmallBricks(true)).rgba;
      EXPECT_GE(inr::ImagePsnr(image, coarse), 35);
      EXPECT_LT(inr::ImagePsnr(image, fine), 30);
    }
  }
}

/// What comes from another level may be outside the range of what is there, and stays as it is.
TEST(UnfinishedDrawing, IsNotMovedIntoOtherLevelsRanges)
{
  const inr::ModelPointer model = WithNarrowRanges();
  inr::Renderer renderer(model, SmallBricks(true));
  renderer.setTransferFunction(ColoursOf(model->volume));
  inr::Image image;
  EXPECT_GT(renderer.render(FrameAt(Coarsest), image).clamped, 20);
  inr::Frame frame = FrameAt(0);
  frame.timeLimit = NoTime;
  const inr::FrameStatistics first = renderer.render(frame, image);
  EXPECT_EQ(first.missed, first.samples);
  EXPECT_LT(first.clamped, 3);
}

/// Level by level, or the wanted ones at once.
TEST(UnfinishedDrawing, AsksForWhatItIsToAskFor)
{
  const inr::Hierarchy levels(TrainedModel()->volume.dims, SmallBricks(true).cache.brickSize,
                              inr::ResolutionOf(*TrainedModel()));
  for (const inr::RenderMode mode : Modes) {
    for (const bool preloading : {true, false}) {
      SCOPED_TRACE(preloading);
      inr::Renderer renderer = RendererOf(SmallBricks(preloading));
      Begin(renderer, FrameAt(Coarsest, mode));
      inr::Frame frame = FrameAt(0, mode);
      frame.timeLimit = NoTime;
      inr::Image image;
      const int coarsest = renderer.render(frame, image).levels.coarsest;
      ASSERT_GE(coarsest, 3);
      for (int level = coarsest - 1; level >= 0; --level) {
        if (!levels.view().isOnTheWay(level)) {
          continue;
        }
        const inr::FrameStatistics next = renderer.render(frame, image);
        const int step = preloading ? level : 0;
        EXPECT_EQ(next.levels.finest, step);
        if (mode == inr::RenderMode::RayMarching) { // paths go elsewhere once they see more
          EXPECT_EQ(next.complete, step == 0);
        }
      }
    }
  }
}

/// As often as it takes.
inr::Image Finish(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  int calls = 1;
  while (!renderer.render(frame, image).complete && calls < 200) {
    ++calls;
  }
  EXPECT_GT(calls, 2);
  EXPECT_LT(calls, 200);
  return image;
}

/// Of paths, those tiles are traced again that have missed something, and no other.
TEST(UnfinishedDrawing, TracesAgainWhatHasMissedSomething)
{
  inr::Frame frame = FrameAt(0, inr::RenderMode::PathTracing);
  frame.width = 100; // four tiles, the last of which is narrow
  frame.height = 40; // two
  frame.samplesPerPixel = 2;
  frame.unitDistance = 0.02; // paths meet a lot before they leave
  frame.paths.ambientLight = glm::vec3(1.0f);
  frame.paths.maximumBounces = frame.paths.rouletteAfter = 100;
  const inr::Image truth = Draw(frame, SmallBricks(true)).rgba;
  inr::Renderer renderer = RendererOf(SmallBricks(true));
  frame.timeLimit = NoTime;
  EXPECT_EQ(Finish(renderer, frame).pixels, truth.pixels);
}

/// A gradient that reaches into a brick which is not there is not what it is to be.
TEST(UnfinishedDrawing, IsNotCompleteWithoutWhatGradientsNeed)
{
  inr::Frame frame = FrameAt(0);
  Shade(frame);
  frame.clippingPlanes = {{1, 0, 0, -16.2}}; // a brick begins at 16
  const inr::Image truth = Draw(frame, SmallBricks(false)).rgba;
  inr::Renderer renderer = RendererOf(SmallBricks(false));
  frame.levelOfDetailScale = Coarsest;
  Begin(renderer, frame);
  frame.levelOfDetailScale = 0;
  frame.timeLimit = NoTime;
  EXPECT_EQ(Finish(renderer, frame).pixels, truth.pixels); // those of samples come first
}

/// Also where nothing waits for all of it.
TEST(UnfinishedDrawing, StopsOnRequest)
{
  for (const inr::RenderMode mode : Modes) {
    for (const bool inTime : {true, false}) {
      for (const int most : {0, 1}) {
        SCOPED_TRACE(std::to_string(static_cast<int>(mode)) + (inTime ? " in time" : ""));
        inr::RendererOptions options = SmallBricks(true);
        options.cache.onlyWhatFits = !inTime;
        inr::Renderer renderer = RendererOf(options);
        Begin(renderer, FrameAt(Coarsest, mode));
        inr::Frame frame = FrameAt(0, mode);
        frame.timeLimit = inTime ? 10 : 0;
        inr::Image image;
        int asked = 0;
        const auto stopAfterSome = [&] { return asked++ < most; };
        EXPECT_THROW(renderer.render(frame, image, nullptr, stopAfterSome), inr::Error);
        EXPECT_EQ(asked, most + 1);
        EXPECT_TRUE(renderer.render(frame, image).complete);
        EXPECT_FALSE(renderer.acceleratorFailure());
      }
    }
  }
}

} // namespace test::unfinished_drawing
