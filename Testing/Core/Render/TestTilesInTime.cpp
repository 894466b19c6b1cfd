// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures whose rays take longer than there is time for: they are made tile by tile, over several
// calls.
#include "Core/Image/Metrics.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/RecordingField.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace test::tiles_in_time {

constexpr glm::i64vec3 Dims(97, 83, 91);

inr::Frame Lit(int view = 0)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 80);
  frame.shading = inr::Material{};
  frame.lights = {Headlight()};
  frame.view = view;
  frame.timeLimit = 1e-3;
  return frame;
}

/// Makes any machine slow.
bool Slowly()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(3));
  return true;
}

inr::Image Whole(const inr::RendererOptions& options, inr::Frame frame)
{
  RecordedScene scene(options, Waves, Dims);
  frame.timeLimit = 0;
  inr::Image image;
  EXPECT_TRUE(scene.renderer.render(frame, image).complete);
  return image;
}

/// Calls until a picture of 25 tiles has something everywhere, after which the rest may be quick.
int Finish(inr::Renderer& renderer, const inr::Frame& frame, inr::Image& image)
{
  int blank = 0;
  while (renderer.render(frame, image, nullptr, Slowly).blank && blank < 50) {
    ++blank;
  }
  inr::FrameStatistics last;
  last.complete = false;
  for (int call = 0; call < 2000 && !last.complete; ++call) {
    last = renderer.render(frame, image);
    EXPECT_FALSE(last.blank);
  }
  EXPECT_TRUE(last.complete);
  return blank;
}

TEST(TilesInTime, LetEverythingThroughUntilTheyAreReached)
{
  RecordedScene scene(SmallBricks(), Waves, Dims);
  inr::Image rgba;
  inr::Image depth;
  inr::Image samples;
  const inr::FrameStatistics first = scene.renderer.render(Lit(), rgba, &depth, Slowly, &samples);
  EXPECT_TRUE(first.blank);
  EXPECT_FALSE(first.complete);
  EXPECT_GT(first.marchSeconds, 0.25); // for all, by those that were reached
  const inr::Image whole = Whole(SmallBricks(), Lit());
  int shown = 0;
  int missing = 0;
  for (std::size_t k = 0; k < depth.pixels.size(); ++k) {
    if (rgba.pixels[4 * k + 3] > 0) {
      ++shown;
    } else {
      missing += whole.pixels[4 * k + 3] > 0 ? 1 : 0;
      EXPECT_EQ(rgba.pixels[4 * k], 0);
      EXPECT_EQ(depth.pixels[k], 1);
    }
    EXPECT_EQ(samples.pixels[2 * k] > 0, samples.pixels[2 * k + 1] >= 0);
  }
  EXPECT_GT(shown, 500);
  EXPECT_GT(missing, 500);
}

TEST(TilesInTime, EndWithThePictureThatIsMadeAtOnce)
{
  for (const std::int64_t bytes : {64 << 20, 300000}) { // or with rays that wait for bricks
    inr::RendererOptions options = SmallBricks();
    options.cache.bytes = bytes;
    RecordedScene scene(options, Waves, Dims);
    inr::Image image;
    EXPECT_GT(Finish(scene.renderer, Lit(), image), 1);
    EXPECT_EQ(image.pixels, Whole(options, Lit()).pixels);
  }
}

TEST(TilesInTime, DoSoOfWhatFits)
{
  inr::RendererOptions options = SmallBricks();
  options.cache.onlyWhatFits = true;
  RecordedScene scene(options, Waves, Dims);
  inr::Image image;
  EXPECT_GT(Finish(scene.renderer, Lit(), image), 0);
  EXPECT_EQ(image.pixels, Whole(options, Lit()).pixels);
  options.cache.bytes = 300000; // where that is not all
  RecordedScene small(options, Waves, Dims);
  EXPECT_GT(Finish(small.renderer, Lit(), image), 0);
}

/// All bricks at once: whatever a tile has shown, it is to be marched again.
inr::RendererOptions AllAtOnce()
{
  inr::RendererOptions options = SmallBricks();
  options.cache.maximumRequests = 100000;
  return options;
}

TEST(TilesInTime, AreReachedBeforeAnyIsMarchedAgain)
{
  RecordedScene scene(AllAtOnce(), Waves, Dims);
  inr::Image image;
  int calls = 1;
  while (scene.renderer.render(Lit(), image, nullptr, Slowly).blank) {
    ASSERT_LE(++calls, 4); // of 25 tiles, eight and more
  }
  EXPECT_GT(calls, 1);
}

TEST(TilesInTime, AreCompleteWhenAllAreMarchedAgain)
{
  RecordedScene scene(AllAtOnce(), Waves, Dims);
  inr::Image image;
  scene.renderer.render(Lit(), image);
  std::this_thread::sleep_for(std::chrono::milliseconds(300)); // while bricks come for all tiles
  int calls = 0;
  while (!scene.renderer.render(Lit(), image, nullptr, Slowly).complete) {
    ASSERT_LE(++calls, 40);
  }
  EXPECT_EQ(image.pixels, Whole(AllAtOnce(), Lit()).pixels);
}

TEST(TilesInTime, DoSoOfSamplesThatAreChosenForATolerance)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 80);
  frame.timeLimit = 1e-3;
  frame.errorTolerance = 8.0;
  RecordedScene scene(SmallBricks(), Waves, Dims);
  inr::Image image;
  EXPECT_GT(Finish(scene.renderer, frame, image), 1);
  EXPECT_EQ(image.pixels, Whole(SmallBricks(), frame).pixels);
}

TEST(TilesInTime, TakeThePlaceOfThoseBeforeSamplesWereChosen)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith(4.0);
  frame.timeLimit = 1e-3;
  inr::Image image;
  inr::FrameStatistics last;
  last.blank = true;
  for (int call = 0; call < 100 && last.blank; ++call) { // meanwhile some cells are measured
    last = renderer.render(frame, image);
  }
  for (int call = 0; call < 2000 && !last.complete; ++call) {
    EXPECT_FALSE(last.blank) << call;
    last = renderer.render(frame, image, nullptr, Slowly);
  }
  EXPECT_TRUE(last.complete);
  inr::Renderer unhurried = MakeRenderer();
  frame.timeLimit = 0;
  EXPECT_LE(inr::ImageMaximumError(image, Draw(unhurried, frame).picture), 2e-3f);
}

TEST(TilesInTime, AreThoseOfEachViewThatGoesOn)
{
  RecordedScene scene(SmallBricks(), Waves, Dims);
  const inr::Frame frames[] = {Lit(1), [] {
                                 inr::Frame other = Lit(2);
                                 other.clipToWorld[0][0] *= 1.1;
                                 return other;
                               }()};
  inr::Image images[2];
  bool complete[2] = {false, false};
  for (int call = 0; call < 200 && !(complete[0] && complete[1]); ++call) {
    const int view = call % 2;
    complete[view] = scene.renderer.render(frames[view], images[view], nullptr, Slowly).complete;
  }
  for (int view = 0; view < 2; ++view) {
    EXPECT_TRUE(complete[view]);
    EXPECT_EQ(images[view].pixels, Whole(SmallBricks(), frames[view]).pixels);
  }
}

} // namespace test::tiles_in_time
