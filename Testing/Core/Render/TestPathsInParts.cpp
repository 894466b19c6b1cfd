// SPDX-License-Identifier: BSD-3-Clause
//
// Path-traced pictures that several calls of the Renderer make, of one view or of several by turns.
#include "Core/Error.h"
#include "Core/Render/Paths/PathPicture.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Core/Render/Scene/PerView.h"
#include "Testing/Core/Render/PathPictures.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <thread>

namespace test::paths_in_parts {

/// Calls with next to no time until the picture is complete; how many.
int RenderInParts(inr::Renderer& renderer, inr::Frame frame, inr::Image& image)
{
  frame.timeLimit = 1e-9;
  std::int64_t paths = 0;
  for (int call = 1; call < 1000; ++call) {
    const inr::FrameStatistics statistics = renderer.render(frame, image);
    EXPECT_GE(statistics.paths, paths);
    EXPECT_LE(statistics.paths, paths + 1);
    EXPECT_EQ(statistics.complete, statistics.paths == frame.samplesPerPixel);
    paths = statistics.paths;
    if (statistics.complete) {
      return call;
    }
  }
  return 1000;
}

TEST(PathsInParts, MakeTheSamePicture)
{
  const inr::Frame frame = LitFrame();
  for (const bool cached : {false, true}) {
    inr::Renderer whole = MakeRenderer(cached);
    inr::Renderer parts = MakeRenderer(cached);
    inr::Image image;
    const int calls = RenderInParts(parts, frame, image);
    EXPECT_GE(calls, frame.samplesPerPixel);
    EXPECT_LT(calls, 300);
    EXPECT_EQ(image.pixels, Render(whole, frame).pixels);
  }
}

TEST(PathsInParts, MakeTheSamePictureWhileBricksLoadBehindIt)
{
  inr::CacheOptions options = SmallBricks();
  options.background = true;
  inr::Renderer parts = MakeRenderer(true, 2, options);
  inr::Frame frame = LitFrame();
  inr::Renderer whole = MakeRenderer(true);
  const inr::Image truth = Render(whole, frame);
  frame.timeLimit = 0.01;
  inr::Image image;
  int calls = 1;
  while (!parts.render(frame, image).complete && calls < 10000) {
    ++calls;
  }
  EXPECT_LT(calls, 10000);
  EXPECT_EQ(image.pixels, truth.pixels);
}

TEST(PathsInParts, ShowWhatThereIsBeforeTheFirstCompleteSample)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame();
  frame.timeLimit = 1e-9;
  inr::Image image;
  const inr::FrameStatistics statistics = renderer.render(frame, image);
  EXPECT_EQ(statistics.paths, 0);
  EXPECT_FALSE(statistics.complete);
  EXPECT_GT(statistics.missed, 0);
  EXPECT_LE(statistics.missed, statistics.samples);
  EXPECT_GT(*std::max_element(image.pixels.begin(), image.pixels.end()), 0.0f);
}

TEST(PathsInParts, EndEvenWhereTheCacheIsTooSmall)
{
  inr::CacheOptions options = SmallBricks();
  options.bytes = 60000;
  inr::Renderer renderer = MakeRenderer(true, 2, options);
  inr::Image image;
  EXPECT_LT(RenderInParts(renderer, LitFrame(), image), 300);
}

TEST(PathsInParts, InferNoMoreTilesThanThereIsTimeFor)
{
  inr::CacheOptions options = SmallBricks();
  options.bytes = 60000;
  inr::Renderer renderer = MakeRenderer(true, 2, options);
  const inr::Frame frame = LitFrame(64); // 16 tiles, more than between two looks at the time
  inr::Image image;
  const int calls = RenderInParts(renderer, frame, image);
  EXPECT_GE(calls, 2 * frame.samplesPerPixel);
  EXPECT_LT(calls, 300);
}

TEST(PathsInParts, TakeNoMoreThanTheirTimeOnceSomethingIsEverywhere)
{
  inr::Renderer renderer = MakeRenderer(true);
  const inr::Frame frame = LitFrame(64); // 16 tiles, more than between two looks at the time
  Render(renderer, frame);               // so that all bricks are there
  inr::Frame other = frame;
  other.view = 1;
  inr::Image image;
  EXPECT_GE(RenderInParts(renderer, other, image), 2 * frame.samplesPerPixel - 1);
}

TEST(PathsInParts, HaveAPartOfTheTimeThatIsShared)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame(64); // 16 tiles, more than between two looks at the time
  Render(renderer, frame);         // so that all bricks are there
  frame.view = 1;
  frame.timeLimit = 1e-9;
  frame.sharedBy = 1000000;
  inr::Image image;
  EXPECT_TRUE(renderer.render(frame, image).blank);
  EXPECT_FALSE(renderer.render(frame, image).blank);
}

/// Calls for one view after the other until all pictures are complete; how many for each of them.
int RenderByTurns(inr::Renderer& renderer, std::vector<inr::Frame> frames,
                  std::vector<inr::Image>& images)
{
  images.resize(frames.size());
  for (int calls = 1; calls < 300; ++calls) {
    bool complete = true;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      frames[k].timeLimit = 1e-9;
      frames[k].view = static_cast<int>(k);
      complete = renderer.render(frames[k], images[k]).complete && complete;
    }
    if (complete) {
      return calls;
    }
  }
  return 300;
}

/// As many pictures from different sides.
std::vector<inr::Frame> Sides(std::size_t count)
{
  std::vector<inr::Frame> frames(count, LitFrame());
  for (std::size_t k = 0; k < count; ++k) {
    frames[k].clipToWorld[3].x += 0.1 * static_cast<double>(k);
  }
  return frames;
}

TEST(PathsInParts, GoOnForEachViewByTurns)
{
  const std::vector<inr::Frame> frames = Sides(inr::PerView<inr::PathPicture>::Most);
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = MakeRenderer(cached);
    std::vector<inr::Image> images;
    EXPECT_LT(RenderByTurns(renderer, frames, images), 100);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      inr::Renderer alone = MakeRenderer(cached);
      EXPECT_EQ(images[k].pixels, Render(alone, frames[k]).pixels) << k;
    }
  }
}

/// As what a selection looks at.
TEST(PathsInParts, BeginAnewWhereTheyWereForgotten)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame();
  inr::Image image;
  Render(renderer, frame);
  ++frame.samplesPerPixel;
  frame.timeLimit = 1e-9;
  renderer.forgetPaths(frame.view + 1);
  EXPECT_TRUE(renderer.render(frame, image).complete); // with one more
  renderer.forgetPaths(frame.view);
  EXPECT_EQ(renderer.render(frame, image).paths, 1);
}

TEST(PathsInParts, GoOnWhenRaysWereMarchedForAnotherView)
{
  inr::Renderer renderer = MakeRenderer(true);
  inr::Frame frame = LitFrame();
  frame.samplesPerPixel = 1000;
  frame.timeLimit = 1e-9;
  inr::Image image;
  std::int64_t paths = 0;
  while (paths < 2) {
    paths = renderer.render(frame, image).paths;
  }
  inr::Frame rays = frame;
  rays.mode = inr::RenderMode::RayMarching;
  rays.view = -1;
  inr::Image other;
  renderer.render(rays, other);
  EXPECT_GE(renderer.render(frame, image).paths, paths);
}

TEST(PerView, KeepsThoseOfTheViewsThatWereDrawnLast)
{
  inr::PerView<inr::PathPicture> pictures;
  const int most = inr::PerView<inr::PathPicture>::Most + 1; // with nobody's
  std::vector<const inr::PathPicture*> first;
  for (int view = 0; view < most; ++view) {
    first.push_back(&pictures.of(view));
  }
  EXPECT_EQ(std::set<const inr::PathPicture*>(first.begin(), first.end()).size(), first.size());
  EXPECT_EQ(&pictures.of(0), first[0]);
  pictures.of(most); // in place of 1
  for (int view = 2; view < most; ++view) {
    EXPECT_EQ(&pictures.of(view), first[static_cast<std::size_t>(view)]);
  }
  EXPECT_EQ(&pictures.of(0), first[0]);
}

TEST(PathsInParts, LoseNothingWhenTheyAreStopped)
{
  inr::Renderer renderer = MakeRenderer(true);
  const inr::Frame frame = LitFrame();
  inr::Image image;
  for (const int patience : {1, 3, 6, 11}) {
    std::atomic<int> asked{0};
    const auto keepGoing = [&] { return ++asked < patience; };
    EXPECT_THROW(renderer.render(frame, image, nullptr, keepGoing), inr::Error);
  }
  inr::Renderer fresh = MakeRenderer(true);
  EXPECT_EQ(Render(renderer, frame).pixels, Render(fresh, frame).pixels);
}

/// Has each look at the field wait.
bool Slowly()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  return true;
}

// A round whose tiles take far longer than there is time for.
TEST(PathsInParts, EndInTheMidstOfARoundThatTakesFarTooLong)
{
  inr::Frame frame = LitFrame(96);
  frame.samplesPerPixel = 1;
  frame.timeLimit = 1e-3;
  inr::Renderer renderer = MakeRenderer(true);
  const inr::Image whole = Render(renderer, [&] {
    inr::Frame unlimited = frame;
    unlimited.timeLimit = 0;
    return unlimited;
  }());
  frame.view = 1;
  const auto holes = [](const inr::Image& image) {
    std::size_t count = 0;
    for (std::size_t k = 3; k < image.pixels.size(); k += 4) {
      count += image.pixels[k] == 0 ? 1 : 0;
    }
    return count;
  };
  inr::Image image;
  const inr::FrameStatistics first = renderer.render(frame, image, nullptr, Slowly);
  EXPECT_FALSE(first.complete);
  EXPECT_EQ(first.paths, 0);
  EXPECT_TRUE(first.blank);
  EXPECT_GT(first.marchSeconds, 0.25); // for all, by those that were reached
  EXPECT_GT(holes(image), holes(whole));
  EXPECT_LT(holes(image), whole.pixels.size() / 4);
  int frames = 1;
  inr::FrameStatistics last = first;
  while (!last.complete) {
    last = renderer.render(frame, image, nullptr, Slowly);
    ASSERT_LT(++frames, 100);
  }
  EXPECT_FALSE(last.blank);
  EXPECT_EQ(image.pixels, whole.pixels);
}

TEST(PathsInParts, ShowSomethingEverywhereBeforeTheyAreCompleteAnywhere)
{
  inr::CacheOptions options = SmallBricks();
  options.maximumRequests = 1; // so that the first tiles lack bricks for long
  inr::Renderer renderer = MakeRenderer(true, 2, options);
  inr::Frame frame = LitFrame(96);
  frame.timeLimit = 1e-3;
  inr::Image image;
  int calls = 1;
  while (renderer.render(frame, image, nullptr, Slowly).blank) {
    ASSERT_LE(++calls, 20);
  }
  EXPECT_GT(calls, 1);
}

} // namespace test::paths_in_parts
