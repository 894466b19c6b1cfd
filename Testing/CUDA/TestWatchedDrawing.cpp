// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that want more bricks than their cache holds, drawn by a machine that counts what it is
// told.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/CUDA/EmulatedRenderers.h"
#include "Testing/CUDA/FailingMachine.h"
#include "Testing/CUDA/OverfullFrames.h"

#include <algorithm>
#include <atomic>
#include <vector>

namespace test::watched_drawing {

using namespace overfull;

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
    std::atomic<int> asked{0};
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

} // namespace test::watched_drawing
