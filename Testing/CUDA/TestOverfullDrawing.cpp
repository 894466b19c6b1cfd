// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that want more bricks than their cache on the device holds, in a limited time: they come
// piece by piece, over several calls.
#include "Testing/CUDA/EmulatedRenderers.h"
#include "Testing/CUDA/FailingMachine.h"
#include "Testing/CUDA/SmallCache.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace test::overfull_drawing {

constexpr double Hurry = 1e-9;  ///< s: a call brings some ray further, and no more
constexpr int MostCalls = 2000; ///< that any of these pictures takes

inr::Frame Hurried(inr::Frame frame)
{
  frame.timeLimit = Hurry;
  return frame;
}

inr::Frame LitFrame(inr::RenderMode mode)
{
  inr::Frame frame = FullResolution(mode);
  Shade(frame);
  return frame;
}

/// Of the same size, from elsewhere.
inr::Frame OtherFrame(inr::RenderMode mode)
{
  inr::Frame frame = FullResolution(mode);
  frame.clipToWorld[0][0] *= 1.1;
  return frame;
}

/// Turned round by half.
inr::Frame FromBehind(inr::Frame frame)
{
  const glm::dvec3 center = 0.5 * glm::dvec3(TrainedModel()->volume.dims);
  glm::dmat4 turn = glm::translate(glm::dmat4(1.0), center);
  turn = glm::rotate(turn, glm::radians(180.0), glm::dvec3(0, 1, 0));
  frame.clipToWorld = glm::translate(turn, -center) * frame.clipToWorld;
  return frame;
}

/// Pixels that show something, and the same to the last bit.
int PixelsOfBoth(const inr::Image& one, const inr::Image& other)
{
  int both = 0;
  for (std::size_t k = 0; k < one.pixels.size(); k += 4) {
    const auto begin = one.pixels.begin() + static_cast<std::ptrdiff_t>(k);
    const bool shows = begin[0] > 0;
    both +=
        shows && std::equal(begin, begin + 4, other.pixels.begin() + static_cast<std::ptrdiff_t>(k))
            ? 1
            : 0;
  }
  return both;
}

/// Pixels that show neither what they showed `before` nor what they are to show in the end.
int PixelsInBetween(const inr::Image& now, const inr::Image& before, const inr::Image& end)
{
  int others = 0;
  for (std::size_t k = 0; k < now.pixels.size(); k += 4) {
    const auto is = [&](const inr::Image& other) {
      return std::equal(now.pixels.begin() + static_cast<std::ptrdiff_t>(k),
                        now.pixels.begin() + static_cast<std::ptrdiff_t>(k + 4),
                        other.pixels.begin() + static_cast<std::ptrdiff_t>(k));
    };
    others += is(before) || is(end) ? 0 : 1;
  }
  return others;
}

/// Draws until a picture waits for more than the cache holds; what there is of it.
inr::FrameStatistics Begin(inr::Renderer& renderer, const inr::Frame& frame, inr::Image& image)
{
  inr::FrameStatistics statistics;
  int calls = 0;
  do {
    statistics = renderer.render(frame, image);
  } while (statistics.missed > 0 && ++calls < MostCalls);
  EXPECT_FALSE(statistics.complete);
  return statistics;
}

/// Draws what a few calls bring.
void DrawSome(inr::Renderer& renderer, const inr::Frame& frame)
{
  inr::Image image;
  for (int call = 0; call < 20; ++call) {
    EXPECT_FALSE(renderer.render(frame, image).complete) << call;
  }
}

/// Draws until a picture is complete.
inr::FrameStatistics End(inr::Renderer& renderer, const inr::Frame& frame, inr::Image& image)
{
  inr::FrameStatistics statistics;
  int calls = 0;
  do {
    statistics = renderer.render(frame, image);
  } while (!statistics.complete && ++calls < MostCalls);
  EXPECT_TRUE(statistics.complete);
  return statistics;
}

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
  int asked = 0;
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
  int asked = 0; // once without a limit, but stopped, when the paths of some tiles have ended
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
      int asked = 0;
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
    int asked = 0;
    const auto stopAfterSome = [&] { return asked++ < most; };
    EXPECT_THROW(renderer.render(frame, image, nullptr, stopAfterSome), inr::Error) << most;
    End(renderer, Hurried(frame), image);
    EXPECT_EQ(image.pixels, truth.rgba.pixels) << most;
  }
}

using WatchedCache = inr::cuda::DeviceCache<FailingMachine, EmulatedInference>;
using WatchedStore = inr::cuda::DeviceStore<FailingMachine, WatchedCache>;

/// Draws through a cache of few bricks, which all of its renderers share, with a few rays at once,
/// on a machine that counts.
class WatchedAccelerator : public EmulatedAccelerator
{
public:
  explicit WatchedAccelerator(std::shared_ptr<FailingOrders> orders, std::int64_t bricks = 20)
      : EmulatedAccelerator(inr::cuda::Precision::Float32, Duty::InfersAndDraws),
        Orders(std::move(orders)), Capacity(bricks)
  {}

  std::shared_ptr<inr::AcceleratedRenderer>
  makeRenderer(const inr::ModelPointer& model, const glm::i64vec3& dims,
               const inr::CacheOptions& options) const override
  {
    if (!this->Store) {
      this->Store = inr::cuda::MakeSharingStore<FailingMachine, WatchedCache>(
          std::make_shared<inr::cuda::CacheShares>(), this->Orders, this->inferenceOf(model),
          inr::Hierarchy(dims, options.brickSize, inr::ResolutionOf(*model)), options.precision,
          BytesFor(this->Capacity, 0), model->macroCells);
    }
    return std::make_shared<inr::cuda::DeviceRenderer<FailingMachine, WatchedCache>>(
        this->Store, options, inr::cuda::WindowSizes{50, 40});
  }

  WatchedCache& cache() const { return this->Store->cache; }

private:
  std::shared_ptr<FailingOrders> Orders;
  std::int64_t Capacity;
  mutable std::shared_ptr<WatchedStore> Store;
};

inr::RendererOptions Watched(std::shared_ptr<const WatchedAccelerator> accelerator)
{
  inr::RendererOptions options = OptionsWith(std::move(accelerator));
  options.cache.brickSize = SmallBrick;
  return options;
}

inr::RendererOptions Watched(std::shared_ptr<FailingOrders> orders)
{
  return Watched(std::make_shared<const WatchedAccelerator>(std::move(orders)));
}

TEST(WatchedDrawing, KeepsToItsTimeInWindowsToo)
{
  for (const inr::RenderMode mode : Modes) {
    const inr::Frame frame = LitFrame(mode);
    const auto whole = std::make_shared<FailingOrders>();
    const Drawn truth = Draw(frame, Watched(whole));
    EXPECT_EQ(truth.rgba.pixels, Draw(frame, RoomFor(Place::Host, 0)).rgba.pixels);
    const auto orders = std::make_shared<FailingOrders>();
    const auto accelerator = std::make_shared<const WatchedAccelerator>(orders);
    inr::Renderer renderer = RendererOf(Watched(accelerator));
    DrawSome(renderer, Hurried(frame));
    inr::Image image;
    int most = 0;
    int calls = 0;
    for (bool complete = false; !complete && calls < MostCalls; ++calls) {
      const int before = orders->kernels;
      complete = renderer.render(Hurried(frame), image).complete;
      most = std::max(most, orders->kernels - before);
      EXPECT_EQ(accelerator->cache().load(1, true).requested, 0) << "and wishes are left";
    }
    EXPECT_EQ(image.pixels, truth.rgba.pixels);
    std::cout << calls << " calls of " << most << " kernels at most, of " << whole->kernels << "\n";
    EXPECT_LT(20 * most, whole->kernels);
  }
}

/// A counted call brings so many bricks for each pass that brings rays no further.
TEST(WatchedDrawing, TakesMoreCallsWhereEachMayBringLess)
{
  int calls[2] = {0, 0};
  for (const int k : {0, 1}) {
    inr::RendererOptions options = Watched(std::make_shared<FailingOrders>());
    options.deterministic = true;
    options.cache.maximumRequests = k == 0 ? 1 : 15;
    inr::Renderer renderer = RendererOf(options);
    Finish(renderer, Hurried(FullResolution(inr::RenderMode::RayMarching)), calls[k]);
  }
  std::cout << calls[0] << " and " << calls[1] << " calls\n";
  EXPECT_GT(calls[0], 3 * calls[1]);
}

TEST(WatchedDrawing, IsNotDrawnAgainWhenItIsFinished)
{
  const inr::Frame frame = LitFrame(inr::RenderMode::RayMarching);
  const auto orders = std::make_shared<FailingOrders>();
  inr::Renderer renderer = RendererOf(Watched(orders));
  inr::Image image;
  inr::Image depth;
  inr::Image samples;
  const inr::FrameStatistics ended = End(renderer, Hurried(frame), image);
  const inr::Image truth = image;
  for (const double limit : {Hurry, 10.0, 0.0}) {
    const int before = orders->kernels;
    inr::Frame again = frame;
    again.timeLimit = limit;
    const inr::FrameStatistics now = renderer.render(again, image, &depth, {}, &samples);
    EXPECT_EQ(orders->kernels, before);
    EXPECT_TRUE(now.complete);
    EXPECT_EQ(now.samples, ended.samples);
    EXPECT_EQ(now.work.gradients, 0);
    EXPECT_EQ(image.pixels, truth.pixels);
  }
  const Drawn whole = Draw(frame, Watched(orders));
  EXPECT_EQ(depth.pixels, whole.depth.pixels);
  EXPECT_EQ(samples.pixels, whole.samples.pixels);
}

/// Each takes away what the other has just brought.
TEST(WatchedDrawing, ComesToItsEndBesideAnotherInTheSameCache)
{
  for (const inr::RenderMode mode : Modes) {
    const auto orders = std::make_shared<FailingOrders>();
    const inr::RendererOptions options = Watched(orders);
    inr::Renderer renderers[2] = {RendererOf(options), RendererOf(options)};
    const inr::Frame frames[2] = {LitFrame(mode), OtherFrame(mode)};
    inr::Image images[2];
    bool complete[2] = {false, false};
    for (int calls = 0; !(complete[0] && complete[1]); ++calls) {
      ASSERT_LT(calls, MostCalls);
      for (int k = 0; k < 2; ++k) {
        complete[k] = renderers[k].render(Hurried(frames[k]), images[k]).complete;
      }
    }
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(images[k].pixels, Draw(frames[k], RoomFor(Place::Host, 0)).rgba.pixels) << k;
    }
  }
}

/// A proof that shows nothing, and is asked for at each picture, leaves what is in the making.
TEST(WatchedDrawing, ComesToItsEndWhereOnlyFineLevelsShowAnything)
{
  inr::TransferFunction peaks = ColoursOf(TrainedModel()->volume);
  for (std::size_t k = 0; k < peaks.table.size(); ++k) {
    peaks.table[k].w = 4 * k < 3 * peaks.table.size() ? 0.0f : 0.5f;
  }
  const inr::Frame frame = LitFrame(inr::RenderMode::PathTracing);
  const auto with = [&](const inr::RendererOptions& options) {
    inr::Renderer renderer = RendererOf(options);
    renderer.setTransferFunction(peaks);
    return renderer;
  };
  inr::Frame coarse = frame;
  coarse.levelOfDetailScale = 1e9;
  inr::Image truth;
  ASSERT_TRUE(with(RoomFor(Place::Host, 0)).render(coarse, truth).complete);
  ASSERT_EQ(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 0.0f);
  ASSERT_TRUE(with(RoomFor(Place::Host, 0)).render(frame, truth).complete);
  ASSERT_GT(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 0.0f);
  inr::Renderer renderer = with(Watched(std::make_shared<FailingOrders>()));
  inr::Image image;
  End(renderer, Hurried(frame), image);
  EXPECT_EQ(image.pixels, truth.pixels);
  EXPECT_FALSE(renderer.acceleratorFailure());
}

/// Nor is a proof that was stopped gone on with for another picture.
TEST(WatchedDrawing, IsProvenByItsOwnPictures)
{
  const inr::Frame frame = LitFrame(inr::RenderMode::PathTracing);
  const inr::Frame other = FromBehind(frame);
  const Drawn truth = Draw(other, RoomFor(Place::Host, 0));
  for (int most = 0; most < 20; ++most) {
    inr::Renderer renderer = RendererOf(Watched(std::make_shared<FailingOrders>()));
    inr::Image image;
    int asked = 0;
    const auto stopAfterSome = [&] { return asked++ < most; };
    EXPECT_THROW(renderer.render(frame, image, nullptr, stopAfterSome), inr::Error) << most;
    EXPECT_TRUE(renderer.render(other, image).accelerated) << most;
    EXPECT_FALSE(renderer.acceleratorFailure())
        << most << " " << renderer.acceleratorFailure()->reason;
    EXPECT_EQ(image.pixels, truth.rgba.pixels) << most;
  }
}

/// The same where either picture would fit, if it had the cache for itself.
TEST(WatchedDrawing, ComesToItsEndBesideAnotherThatFitsOnlyAlone)
{
  for (const inr::RenderMode mode : Modes) {
    inr::Frame frames[2] = {FullResolution(mode), FullResolution(mode)};
    for (int k = 0; k < 2; ++k) { // slabs side by side
      const glm::dvec3 normal(k == 0 ? 1 : -1, 0, 0);
      const glm::dvec4 width(0, 0, 0, TrainedModel()->volume.dims.x / 6.0);
      frames[k].clippingPlanes = {PlaneAcross(normal), PlaneAcross(-normal) + width};
    }
    std::int64_t most = 0;
    for (const inr::Frame& frame : frames) {
      inr::Renderer alone = RendererOf(RoomFor(Place::Host, 0));
      inr::Image image;
      End(alone, Hurried(frame), image);
      most = std::max(most, alone.cachedBricks());
    }
    ASSERT_LT(most, 120);
    const inr::RendererOptions options = Watched(
        std::make_shared<const WatchedAccelerator>(std::make_shared<FailingOrders>(), most + 1));
    inr::Renderer renderers[2] = {RendererOf(options), RendererOf(options)};
    inr::Image images[2];
    bool complete[2] = {false, false};
    for (int calls = 0; !(complete[0] && complete[1]); ++calls) {
      ASSERT_LT(calls, MostCalls) << complete[0] << complete[1];
      for (int k = 0; k < 2; ++k) {
        complete[k] = renderers[k].render(Hurried(frames[k]), images[k]).complete;
      }
    }
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(images[k].pixels, Draw(frames[k], RoomFor(Place::Host, 0)).rgba.pixels) << k;
    }
  }
}

} // namespace test::overfull_drawing
