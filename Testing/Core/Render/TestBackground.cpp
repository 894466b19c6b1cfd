// SPDX-License-Identifier: BSD-3-Clause
//
// Bricks that come in between frames: what may change is when a picture is complete, never the
// complete picture.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/Scene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <thread>

namespace test::background {

const glm::i64vec3 Dims(90, 70, 80);

inr::TransferFunction Colours(float opaqueFrom)
{
  inr::TransferFunction function;
  for (int k = 0; k < 64; ++k) {
    const float x = static_cast<float>(k) / 63;
    function.table.emplace_back(x, 1 - x, 0.5f, x > opaqueFrom ? 0.3f * (x - opaqueFrom) : 0.0f);
  }
  return function;
}

inr::Frame View(double degrees)
{
  inr::Frame frame;
  frame.width = 40;
  frame.height = 33;
  const glm::dvec3 dims(Dims);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0, 1, 0));
  const glm::dvec3 eye = 0.5 * dims + glm::dvec3(turn * glm::dvec4(25, 45, 190, 0));
  frame.clipToWorld = glm::inverse(glm::perspective(glm::radians(40.0), 1.2, 50.0, 1000.0) *
                                   glm::lookAt(eye, 0.5 * dims, glm::dvec3(0, 1, 0)));
  frame.levelOfDetailScale = 0;
  return frame;
}

/// Lets all threads but the one that made it wait while it is closed.
class Gate
{
public:
  void close() { this->Closed = true; }
  void open()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Closed = false;
    }
    this->Opened.notify_all();
  }
  void pass()
  {
    if (this->Closed && std::this_thread::get_id() != this->Maker) {
      std::unique_lock<std::mutex> lock(this->Mutex);
      this->Opened.wait(lock, [this] { return !this->Closed; });
    }
  }

private:
  const std::thread::id Maker = std::this_thread::get_id();
  std::mutex Mutex;
  std::condition_variable Opened;
  std::atomic<bool> Closed = false;
};

/// Waves, and how many values of them were asked for.
class Field
{
public:
  std::shared_ptr<const inr::Evaluator> evaluator() const
  {
    return std::make_shared<FieldEvaluator>(
        [asked = this->Asked, gate = this->Others](const glm::vec3& u) {
          gate->pass();
          ++*asked;
          return 0.5f + 0.5f * std::sin(9.0f * u.x + 4.0f * u.y) * std::cos(7.0f * u.z);
        });
  }
  std::int64_t asked() const { return *this->Asked; }
  Gate& others() const { return *this->Others; } ///< threads than the test's

  inr::Renderer renderer(bool background, std::int64_t bytes = 64 << 20, int threads = 2) const
  {
    inr::RendererOptions options;
    options.threads = threads;
    options.cache.brickSize = 16;
    options.cache.bytes = bytes;
    options.cache.background = background;
    inr::Renderer renderer(this->evaluator(), VolumeOf(Dims), {}, options);
    renderer.setTransferFunction(Colours(0.5f));
    return renderer;
  }

private:
  std::shared_ptr<std::atomic<std::int64_t>> Asked = std::make_shared<std::atomic<std::int64_t>>(0);
  std::shared_ptr<Gate> Others = std::make_shared<Gate>();
};

/// Renders until the picture is complete; how many frames that took.
int Finish(inr::Renderer& renderer, inr::Frame frame, double timeLimit, inr::Image& image)
{
  frame.timeLimit = timeLimit;
  for (int frames = 1; frames < 20000; ++frames) {
    if (renderer.render(frame, image).complete) {
      return frames;
    }
  }
  ADD_FAILURE() << "never complete";
  return 0;
}

TEST(Background, FramesInALimitedTimeEndWithTheCompletePicture)
{
  const Field field;
  inr::Renderer complete = field.renderer(false);
  const inr::Image truth = Render(complete, View(0));
  for (const double timeLimit : {1e-9, 0.002, 0.05}) {
    inr::Renderer hurried = field.renderer(true);
    inr::Image image;
    EXPECT_GT(Finish(hurried, View(0), timeLimit, image), timeLimit < 1e-6 ? 1 : 0);
    EXPECT_EQ(image.pixels, truth.pixels) << timeLimit;
  }
}

TEST(Background, PathsEndWithTheCompletePicture)
{
  const Field field;
  inr::Frame frame = View(0);
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 2;
  inr::Renderer complete = field.renderer(false);
  const inr::Image truth = Render(complete, frame);
  for (const double timeLimit : {0.002, 0.05}) {
    inr::Renderer hurried = field.renderer(true);
    inr::Image image;
    Finish(hurried, frame, timeLimit, image);
    EXPECT_EQ(image.pixels, truth.pixels) << timeLimit;
  }
}

TEST(Background, CompleteFramesAreTheSameWhateverIsOnItsWay)
{
  const Field field;
  inr::Renderer synchronous = field.renderer(false);
  inr::Renderer busy = field.renderer(true);
  inr::Image image;
  for (const double degrees : {0.0, 20.0, 40.0}) {
    inr::Frame frame = View(degrees + 90);
    frame.timeLimit = 0.001;
    busy.render(frame, image);
    EXPECT_EQ(Render(busy, View(degrees)).pixels, Render(synchronous, View(degrees)).pixels);
  }
}

/// Waits until nothing more is asked of `field`; on a busy machine those who ask come last.
void Settle(const Field& field)
{
  std::int64_t asked = -1;
  for (int k = 0; k < 120 && field.asked() != asked; ++k) {
    asked = field.asked();
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
}

TEST(Background, BricksComeInBetweenFrames)
{
  const Field field;
  inr::Frame frame = View(0);
  frame.timeLimit = 1e-9;
  inr::Image image;
  inr::Renderer renderer = field.renderer(true, 64 << 20, 1);
  // Else all may have been loaded before this thread came to count what the frame asked for.
  field.others().close();
  renderer.render(frame, image);
  const std::int64_t rendered = field.asked();
  field.others().open();
  Settle(field);
  // More than what was left of the layer that the frame had begun: of a coarse level, whose voxels
  // are the mean of eight values.
  EXPECT_GT(field.asked(), rendered + 8 * 16 * 16) << "nothing was loaded between frames";

  // A frame asks for as much as it came to see before it was stopped, so it may take a few.
  const std::int64_t before = renderer.cachedBricks();
  for (int frames = 0; frames < 20 && renderer.cachedBricks() < before + 5; ++frames) {
    renderer.render(frame, image);
    Settle(field);
  }
  EXPECT_GE(renderer.cachedBricks(), before + 5);

  const std::int64_t asked = field.asked();
  inr::Renderer synchronous = field.renderer(false);
  synchronous.render(frame, image);
  const std::int64_t after = field.asked();
  EXPECT_GT(after, asked);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  renderer = std::move(synchronous); // what was on its way goes with its renderer
  const std::int64_t rest = field.asked();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(field.asked(), rest);
}

TEST(Background, QueueAndCacheKeepTheBudgetTogether)
{
  const Field field;
  for (const std::int64_t bytes : {100000, 400000}) {
    inr::Renderer renderer = field.renderer(true, bytes);
    inr::Image image;
    Finish(renderer, View(0), 0.01, image);
    EXPECT_LE(renderer.cacheBytes(), bytes);
    EXPECT_GT(renderer.cacheBytes(), bytes / 2);
  }
}

// What ThreadSanitizer is to watch.
TEST(Background, CameraAndColoursMayChangeWhileBricksLoad)
{
  const Field field;
  inr::Image image;
  for (const std::int64_t bytes : {400000, 64 << 20}) {
    inr::Renderer renderer = field.renderer(true, bytes);
    for (int k = 0; k < 30; ++k) {
      inr::Frame frame = View(7.0 * k);
      frame.timeLimit = k % 3 == 0 ? 1e-9 : 0.002;
      frame.levelOfDetailScale = k % 4;
      if (k % 5 == 0) {
        renderer.setTransferFunction(Colours(0.3f + 0.01f * static_cast<float>(k % 7)));
      }
      const inr::FrameStatistics statistics = renderer.render(frame, image);
      EXPECT_GT(statistics.samples, 0);
      if (k % 5 == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
      }
      if (k % 10 == 9) {
        renderer = field.renderer(true, bytes); // while bricks are on their way
      }
    }
    renderer.setTransferFunction(Colours(0.5f));
    Finish(renderer, View(0), 0.01, image);
    inr::Renderer synchronous = field.renderer(false);
    EXPECT_EQ(image.pixels, Render(synchronous, View(0)).pixels);
  }
}

/// Whether this process computes while the calling thread sleeps: ten times as much as the few
/// glances at the clock take.
bool IsAtWork()
{
  const std::clock_t before = std::clock();
  const auto working = [&] { return std::clock() - before >= CLOCKS_PER_SEC / 50; };
  for (int k = 0; k < 40 && !working(); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
  }
  return working();
}

/// Ends the process with bricks of a network on their way and nobody to delete the renderer, as an
/// application does that just exits.
void ExitWhileBricksLoad()
{
  inr::Description description;
  description.grid.log2HashmapSize = 14; // filling a larger one takes longer than all the rest
  const auto model = RandomModel(description);
  model->volume.dims = glm::i64vec3(2000);
  inr::RendererOptions options;
  options.cache.bytes = 512 << 20;
  options.cache.brickSize = 40; // a quarter of a second's work in all
  options.cache.preloading = false;
  static auto* renderer = new inr::Renderer(model, options); // nothing of it runs at the end
  renderer->setTransferFunction(Colours(0.0f));
  inr::Frame frame = View(0);
  frame.timeLimit = 1e-9;
  inr::Image image;
  renderer->render(frame, image);
  std::exit(IsAtWork() ? 0 : 1);
}

TEST(BackgroundDeathTest, TheProcessMayExitWhileBricksLoad)
{
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(ExitWhileBricksLoad(), testing::ExitedWithCode(0), "");
}

} // namespace test::background
