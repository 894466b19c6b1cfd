// SPDX-License-Identifier: BSD-3-Clause
//
// Several renderers in a process: what they share, and that none sees it in its pictures.
#include "Core/Error.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/SharedScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace test::sharing {

TEST(Sharing, ABrickIsInferredOnceForAllViewsOfAVolume)
{
  const CountedWaves field(1);
  inr::Renderer first = field.renderer(SharedCache(EnoughToShare));
  inr::Frame part = SharedView(false);
  part.clippingPlanes = {glm::dvec4(-1, 0, 0, 30)};
  const inr::Image image = Render(first, part);
  const std::int64_t asked = field.asked();
  const std::int64_t bytes = first.cacheBytes();
  inr::Renderer second = field.renderer(SharedCache(EnoughToShare), 2);
  EXPECT_EQ(Render(second, part).pixels, image.pixels);
  EXPECT_EQ(field.asked(), asked);
  EXPECT_EQ(second.cacheBytes(), bytes);
  EXPECT_EQ(second.cachedBricks(), first.cachedBricks());
  { // what it brings is there for the first
    const std::vector<float> other = Render(second, SharedView(true)).pixels;
    EXPECT_GT(field.asked(), asked);
    const std::int64_t all = field.asked();
    second = field.renderer(SharedCache(EnoughToShare));
    EXPECT_EQ(Render(first, SharedView(true)).pixels, other);
    EXPECT_EQ(field.asked(), all);
  }
}

TEST(Sharing, BricksOutliveARendererThatIsReplaced)
{
  const CountedWaves field(1);
  inr::Renderer renderer = field.renderer(SharedCache(EnoughToShare));
  Render(renderer, SharedView(false));
  const std::int64_t bricks = renderer.cachedBricks();
  const std::int64_t asked = field.asked();
  inr::CacheOptions others = SharedCache(EnoughToShare);
  others.ranking = !others.ranking;
  others.preloading = !others.preloading;
  others.maximumRequests = 7;
  renderer = field.renderer(others, 2);
  EXPECT_EQ(renderer.cachedBricks(), bricks);
  Render(renderer, SharedView(false));
  EXPECT_EQ(field.asked(), asked);
}

/// Voxels of few bits are rounded over the ranges of the cells.
TEST(Sharing, OfOneFieldButNotOfTwoSetsOfRanges)
{
  const auto field =
      std::make_shared<FieldEvaluator>([](const glm::vec3& u) { return 0.5f + 0.004f * Waves(u); });
  inr::MacroCells wide = inr::MakeMacroCells(SharedDims, 16);
  wide.provenance = inr::MacroCellProvenance::Training;
  std::fill(wide.ranges.begin(), wide.ranges.end(), inr::ValueRange{0.0f, 1.0f});
  inr::RendererOptions options;
  options.threads = 1;
  options.cache = SharedCache(EnoughToShare, false);
  options.cache.precision = inr::CachePrecision::Bits8;
  const auto drawn = [&](const inr::MacroCells& cells) {
    inr::Renderer renderer(field, VolumeOf(SharedDims), cells, options);
    inr::TransferFunction colours = Colours();
    colours.low = 0.495;
    colours.high = 0.505;
    renderer.setTransferFunction(colours);
    return Render(renderer, SharedView(false)).pixels;
  };
  const std::vector<float> alone = drawn({});
  const inr::Renderer other(field, VolumeOf(SharedDims), wide, options);
  EXPECT_EQ(drawn({}), alone);
  EXPECT_NE(drawn(wide), alone);
}

TEST(Sharing, OfOneModelButNotOfTwo)
{
  const auto model = RandomModel(SmallDescription());
  model->volume.dims = SharedDims;
  const auto copy = std::make_shared<inr::Model>(*model);
  inr::RendererOptions options;
  options.cache = SharedCache(EnoughToShare);
  const auto bytesWith = [&](const inr::ModelPointer& of, inr::Renderer& before) {
    inr::Renderer renderer(of, options);
    renderer.setTransferFunction(Colours());
    Render(renderer, Oblique(glm::dvec3(model->volume.dims)));
    EXPECT_EQ(before.cacheBytes(), renderer.cacheBytes());
    return renderer.cacheBytes();
  };
  inr::Renderer first(model, options);
  first.setTransferFunction(Colours());
  Render(first, Oblique(glm::dvec3(model->volume.dims)));
  const std::int64_t alone = first.cacheBytes();
  EXPECT_EQ(bytesWith(model, first), alone);
  EXPECT_GT(bytesWith(copy, first), alone * 3 / 2);
  EXPECT_EQ(first.cacheBytes(), alone);
}

/// Renders frames of the two in turns until both are complete, and compares with what each is
/// alone.
void Alternate(const CountedWaves& a, const CountedWaves& b, const inr::Frame (&frames)[2],
               std::int64_t bytes)
{
  inr::Renderer renderers[2] = {a.renderer(SharedCache(bytes)), b.renderer(SharedCache(bytes))};
  inr::Image images[2];
  bool complete[2] = {false, false};
  for (int k = 0; k < 20000 && !(complete[0] && complete[1]); ++k) {
    for (const int at : {0, 1}) {
      complete[at] = renderers[at].render(frames[at], images[at]).complete;
      ASSERT_LE(renderers[at].cacheBytes(), bytes);
    }
  }
  EXPECT_TRUE(complete[0] && complete[1]);
  EXPECT_TRUE(images[0].pixels == DrawnAlone(a, frames[0]));
  EXPECT_TRUE(images[1].pixels == DrawnAlone(b, frames[1]));
}

class SharingInTurns : public testing::TestWithParam<double>
{
protected:
  void alternate(const inr::Frame& like, std::int64_t bytes)
  {
    inr::Frame frames[2] = {SharedView(false), SharedView(true)};
    for (inr::Frame& frame : frames) {
      frame.mode = like.mode;
      frame.shading = like.shading;
      frame.lights = like.lights;
      frame.samplesPerPixel = like.samplesPerPixel;
      frame.timeLimit = GetParam();
    }
    const CountedWaves a(1);
    const CountedWaves b(0.7f);
    {
      SCOPED_TRACE("two volumes");
      Alternate(a, b, frames, bytes);
    }
    {
      SCOPED_TRACE("two views of one volume");
      Alternate(a, a, frames, bytes);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(TimeLimits, SharingInTurns, testing::Values(0, 1e-9, 0.002),
                         [](const auto& info) {
                           return info.param > 0
                                      ? std::to_string(std::lround(info.param * 1e9)) + "ns"
                                      : std::string("None");
                         });

TEST_P(SharingInTurns, EachHasItsPictureWhereBothFit) { this->alternate({}, EnoughToShare); }

TEST_P(SharingInTurns, EachHasItsPictureWhereNoneFits) { this->alternate({}, HalfOfASharedView); }

TEST_P(SharingInTurns, EachHasItsPictureWhereOneFitsButNotBoth)
{
  const CountedWaves field(1);
  std::int64_t bytes = 0;
  {
    inr::Renderer alone = field.renderer(SharedCache(EnoughToShare, false));
    Render(alone, SharedView(true));
    bytes = alone.cacheBytes();
  }
  this->alternate({}, bytes * 3 / 2);
}

TEST_P(SharingInTurns, EachHasItsShadedPicture)
{
  inr::Frame lit;
  lit.shading = inr::Material{};
  lit.lights.resize(1);
  this->alternate(lit, HalfOfASharedView);
}

TEST(Sharing, PathsComeToAnEndWhateverTheOtherTakes)
{
  const CountedWaves fields[2] = {CountedWaves(1), CountedWaves(0.7f)};
  inr::Frame frame = SharedView(false);
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 2;
  const std::vector<float> truth[2] = {DrawnAlone(fields[0], frame), DrawnAlone(fields[1], frame)};
  for (const double timeLimit : {0.0, 1e-9, 0.002}) {
    frame.timeLimit = timeLimit;
    for (const std::int64_t bytes : {EnoughToShare, 2 * HalfOfASharedView}) {
      inr::Renderer renderers[2] = {fields[0].renderer(SharedCache(bytes)),
                                    fields[1].renderer(SharedCache(bytes))};
      bool complete[2] = {false, false};
      inr::Image images[2];
      for (int k = 0; k < 20000 && !(complete[0] && complete[1]); ++k) {
        complete[0] = renderers[0].render(frame, images[0]).complete;
        complete[1] = renderers[1].render(frame, images[1]).complete;
      }
      EXPECT_TRUE(complete[0] && complete[1]);
      if (bytes == EnoughToShare) {
        EXPECT_EQ(images[0].pixels, truth[0]);
        EXPECT_EQ(images[1].pixels, truth[1]);
      }
    }
  }
}

/// Of a renderer that draws several views by turns each comes to its end, even where the cache
/// holds half of what one of them wants.
TEST(Sharing, ViewsOfOneRendererGoOnByTurns)
{
  const CountedWaves field(1);
  inr::Renderer renderer = field.renderer(SharedCache(HalfOfASharedView, false));
  inr::Frame frames[] = {SharedView(false), SharedView(true)};
  inr::Image images[2];
  bool complete[2] = {false, false};
  int calls = 0;
  while (!(complete[0] && complete[1]) && calls < 2000) {
    for (int k = 0; k < 2; ++k, ++calls) {
      frames[k].view = k;
      frames[k].timeLimit = 1e-9;
      complete[k] = renderer.render(frames[k], images[k]).complete;
    }
  }
  EXPECT_GT(calls, 4);
  EXPECT_LT(calls, 2000);
  for (int k = 0; k < 2; ++k) {
    EXPECT_EQ(images[k].pixels, DrawnAlone(field, frames[k])) << k;
  }
  frames[0].timeLimit = 1e-9; // finished ones are only shown
  EXPECT_EQ(renderer.render(frames[0], images[0]).work.bricks.bricks, 0);
}

TEST(Sharing, ASmallCacheBesideALargeOneCompletesItsPicture)
{
  const CountedWaves fields[2] = {CountedWaves(1), CountedWaves(0.7f)};
  inr::Renderer large = fields[0].renderer(SharedCache(EnoughToShare));
  inr::Renderer small = fields[1].renderer(SharedCache(HalfOfASharedView));
  Render(large, SharedView(false));
  EXPECT_EQ(Render(small, SharedView(false)).pixels, DrawnAlone(fields[1], SharedView(false)));
  EXPECT_LE(large.cacheBytes(), EnoughToShare);
  EXPECT_GT(large.cacheBytes(), 2 * HalfOfASharedView);
}

TEST(Sharing, AnotherMayRenderOrGoInTheMiddleOfAPicture)
{
  const CountedWaves fields[2] = {CountedWaves(1), CountedWaves(0.7f)};
  const std::int64_t bytes = HalfOfASharedView;
  inr::Renderer renderer = fields[0].renderer(SharedCache(bytes));
  auto other = std::make_unique<inr::Renderer>(fields[1].renderer(SharedCache(bytes)));
  inr::Renderer same = fields[0].renderer(SharedCache(bytes));
  inr::Image image;
  inr::Frame soon = SharedView(true);
  soon.timeLimit = 1e-9;
  other->render(soon, image); // and now bricks are on their way
  int step = 0;
  const auto self = std::this_thread::get_id();
  const auto keepGoing = [&] {
    if (std::this_thread::get_id() == self) {
      inr::Image within;
      ++step;
      if (step == 2) {
        EXPECT_EQ(Render(*other, SharedView(true)).pixels, DrawnAlone(fields[1], SharedView(true)));
        EXPECT_THROW(same.render(SharedView(true), within), inr::Error);
      } else if (step == 3) {
        other.reset();
      }
    }
    return true;
  };
  renderer.render(SharedView(false), image, nullptr, keepGoing);
  EXPECT_GE(step, 3);
  EXPECT_EQ(image.pixels, DrawnAlone(fields[0], SharedView(false)));
  EXPECT_EQ(Render(same, SharedView(true)).pixels, DrawnAlone(fields[0], SharedView(true)));
}

/// A host is asked on the renderer's threads, too: what renders there would wait for ever.
TEST(Sharing, AnotherIsRefusedInTheMiddleOnAnyThread)
{
  const CountedWaves field(1);
  inr::Renderer renderer = field.renderer(SharedCache(HalfOfASharedView), 4);
  inr::Renderer same = field.renderer(SharedCache(HalfOfASharedView), 4);
  std::mutex mutex;
  int refused = 0;
  const auto self = std::this_thread::get_id();
  std::atomic<bool> elsewhere{false};
  const auto keepGoing = [&] {
    const bool isOther = std::this_thread::get_id() != self;
    elsewhere = elsewhere || isOther;
    const auto start = std::chrono::steady_clock::now();
    while (!elsewhere && std::chrono::steady_clock::now() - start < std::chrono::seconds(1)) {
      std::this_thread::yield(); // until another thread has been here, where there is one
    }
    const std::lock_guard<std::mutex> lock(mutex);
    inr::Image within;
    try {
      same.render(SharedView(true), within);
    } catch (const inr::Error& error) {
      refused += error.code() == inr::ErrorCode::Cancelled ? 1 : 0;
    }
    return true;
  };
  inr::Image image;
  renderer.render(SharedView(false), image, nullptr, keepGoing);
  EXPECT_GT(refused, 1);
  EXPECT_EQ(image.pixels, DrawnAlone(field, SharedView(false)));
  if (!elsewhere) {
    GTEST_SKIP() << "there is no other thread on this machine";
  }
}

/// One that comes in the midst of a picture may leave it less room than it already uses.
TEST(Sharing, OneThatComesInTheMidstTakesRoom)
{
  const CountedWaves fields[2] = {CountedWaves(1), CountedWaves(0.7f)};
  for (const inr::RenderMode mode : {inr::RenderMode::RayMarching, inr::RenderMode::PathTracing}) {
    inr::Renderer renderer = fields[0].renderer(SharedCache(HalfOfASharedView));
    for (int k = 0; k < 20; ++k) {
      inr::Frame frame = SharedView(false);
      frame.mode = mode;
      frame.clipToWorld[0][0] *= 1 + 0.003 * k;
      frame.timeLimit = k <= 4 ? 0 : 1e-9;
      std::optional<inr::Renderer> other;
      const auto come = [&] {
        if (!other && k > 4) {
          other.emplace(fields[1].renderer(SharedCache(HalfOfASharedView)));
        }
        return true;
      };
      inr::Image image;
      renderer.render(frame, image, nullptr, come);
      EXPECT_EQ(image.width, frame.width);
    }
  }
}

// What ThreadSanitizer is to watch.
TEST(Sharing, RenderersOnSeveralThreadsHaveTheirPictures)
{
  const CountedWaves fields[2] = {CountedWaves(1), CountedWaves(0.7f)};
  const std::vector<float> truth[2] = {DrawnAlone(fields[0], SharedView(false)),
                                       DrawnAlone(fields[1], SharedView(false))};
  std::atomic<std::int64_t> most{0};
  const auto work = [&](std::size_t seed) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = (seed + k) % 2;
      inr::Renderer renderer = fields[at].renderer(SharedCache(HalfOfASharedView));
      inr::Frame frame = SharedView(false);
      frame.timeLimit = k == 1 ? 0.0 : 0.01;
      inr::Image image;
      for (int tries = 0; tries < 5000 && !renderer.render(frame, image).complete; ++tries) {
        most = std::max(most.load(), renderer.cacheBytes());
      }
      EXPECT_EQ(image.pixels, truth[at]);
    }
  };
  std::thread first(work, 0);
  std::thread second(work, 1);
  work(2);
  first.join();
  second.join();
  constexpr std::int64_t tables = 1000; // of who comes while all of it is in use
  EXPECT_LE(most, HalfOfASharedView + tables);
}

} // namespace test::sharing
