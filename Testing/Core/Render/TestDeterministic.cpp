// SPDX-License-Identifier: BSD-3-Clause
//
// Frames in a limited time that no clock has a part in: the same sequence is the same pictures,
// however fast the machine is.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

namespace test::deterministic {

const glm::i64vec3 Dims(70, 90, 60);

/// What the clock sees of a run.
struct Machine
{
  int threads;
  bool slow; ///< to infer, and busy with something else
};

/// Keeps a core busy.
class Load
{
public:
  explicit Load(bool on) : Going(on)
  {
    if (on) {
      this->Thread = std::thread([this] {
        while (this->Going) {
        }
      });
    }
  }
  ~Load()
  {
    this->Going = false;
    if (this->Thread.joinable()) {
      this->Thread.join();
    }
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

private:
  std::atomic<bool> Going;
  std::thread Thread;
};

FieldEvaluator::Function WavesOn(const Machine& machine)
{
  if (!machine.slow) {
    return Waves;
  }
  return [asked = std::make_shared<std::atomic<int>>(0)](const glm::vec3& u) {
    if (++*asked % 1024 == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return Waves(u);
  };
}

/// What is rendered, and how.
struct Scenario
{
  inr::RenderMode mode = inr::RenderMode::RayMarching;
  bool cached = true;
  bool deterministic = true;
  bool onlyWhatFits = false;
  std::int64_t cacheBytes = 64 << 20;
};

/// Everything that a sequence of frames shows.
struct Sequence
{
  std::vector<float> pixels;
  std::vector<std::int64_t> missed; ///< of each frame
  int unfinished = 0;               ///< frames

  bool operator==(const Sequence& other) const
  {
    return this->pixels == other.pixels && this->missed == other.missed;
  }
};

std::unique_ptr<inr::Renderer> MakeRenderer(const std::shared_ptr<const inr::Evaluator>& field,
                                            const Scenario& scenario, int threads)
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cached = scenario.cached;
  options.deterministic = scenario.deterministic;
  options.cache.brickSize = 16;
  options.cache.bytes = scenario.cacheBytes;
  options.cache.maximumRequests = 3;
  options.cache.onlyWhatFits = scenario.onlyWhatFits;
  auto renderer =
      std::make_unique<inr::Renderer>(field, VolumeOf(Dims), inr::MacroCells{}, options);
  renderer->setTransferFunction(Colours());
  return renderer;
}

inr::Frame View(int at, const Scenario& scenario)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 40);
  Turn(frame, glm::dvec3(Dims), 0.06 * at);
  frame.mode = scenario.mode;
  frame.samplesPerPixel = scenario.deterministic ? 2 : 64;
  frame.timeLimit = 0.02;
  return frame;
}

/// A camera that moves and stands still in turns.
Sequence Fly(const Scenario& scenario, const Machine& machine)
{
  const Load load(machine.slow);
  const auto field = std::make_shared<FieldEvaluator>(WavesOn(machine));
  const auto camera = MakeRenderer(field, scenario, machine.threads);
  Sequence sequence;
  for (int k = 0; k < 14; ++k) {
    inr::Image image;
    const inr::FrameStatistics statistics = camera->render(View(k / 3, scenario), image);
    sequence.pixels.insert(sequence.pixels.end(), image.pixels.begin(), image.pixels.end());
    sequence.missed.push_back(statistics.missed);
    sequence.unfinished += statistics.complete ? 0 : 1;
  }
  return sequence;
}

void ExpectTheSameEverywhere(const Scenario& scenario)
{
  const Sequence truth = Fly(scenario, {1, false});
  EXPECT_GT(truth.unfinished, 4); // a finished picture would be the same anyway
  EXPECT_TRUE(Fly(scenario, {1, false}) == truth);
  EXPECT_TRUE(Fly(scenario, {2, false}) == truth);
  EXPECT_TRUE(Fly(scenario, {1, true}) == truth);
  EXPECT_TRUE(Fly(scenario, {2, true}) == truth);
}

constexpr std::int64_t TwentyBricks = 200000; ///< of more than a hundred

Scenario Paths(std::int64_t bytes, bool cached = true)
{
  Scenario scenario;
  scenario.mode = inr::RenderMode::PathTracing;
  scenario.cached = cached;
  scenario.cacheBytes = bytes;
  return scenario;
}

Scenario SmallCache()
{
  Scenario scenario;
  scenario.cacheBytes = TwentyBricks;
  return scenario;
}

TEST(Deterministic, RaysAreTheSameOnAnyMachine) { ExpectTheSameEverywhere({}); }

TEST(Deterministic, RaysAreTheSameWhereTheCacheIsTooSmall)
{
  ExpectTheSameEverywhere(SmallCache());
}

TEST(Deterministic, PathsAreTheSameOnAnyMachine) { ExpectTheSameEverywhere(Paths(64 << 20)); }

TEST(Deterministic, PathsAreTheSameWhereTheCacheIsTooSmall)
{
  ExpectTheSameEverywhere(Paths(TwentyBricks));
}

TEST(Deterministic, PathsAreTheSameWithoutACache) { ExpectTheSameEverywhere(Paths(0, false)); }

TEST(Deterministic, PicturesOfWhatFitsAreTheSameOnAnyMachine)
{
  for (Scenario scenario : {SmallCache(), Paths(TwentyBricks)}) {
    scenario.onlyWhatFits = true;
    ExpectTheSameEverywhere(scenario);
  }
}

TEST(Deterministic, AClockDecidesWithoutIt)
{
  for (Scenario scenario : {Scenario{}, Paths(64 << 20), Paths(0, false)}) {
    scenario.deterministic = false;
    EXPECT_FALSE(Fly(scenario, {1, false}) == Fly(scenario, {1, true})) << scenario.cached;
  }
}

TEST(Deterministic, HasNothingToDoWithWhatIsNot)
{
  const auto field = std::make_shared<FieldEvaluator>(Waves);
  Scenario scenario;
  const Sequence truth = Fly(scenario, {1, false});
  const auto camera = MakeRenderer(field, scenario, 1);
  scenario.deterministic = false;
  const auto other = MakeRenderer(field, scenario, 1);
  Sequence sequence;
  for (int k = 0; k < 14; ++k) {
    inr::Image image;
    other->render(View(k / 3, scenario), image);
    sequence.missed.push_back(camera->render(View(k / 3, scenario), image).missed);
    sequence.pixels.insert(sequence.pixels.end(), image.pixels.begin(), image.pixels.end());
  }
  EXPECT_TRUE(sequence == truth);
}

/// In how many frames the view is complete, and the complete view.
int Finish(const Scenario& scenario, inr::Image& image)
{
  const auto renderer = MakeRenderer(std::make_shared<FieldEvaluator>(Waves), scenario, 2);
  inr::Frame frame = View(0, scenario);
  frame.samplesPerPixel = 2;
  frame.timeLimit = scenario.deterministic ? 1e9 : 0; // only counting ends a frame
  int frames = 1;
  while (!renderer->render(frame, image).complete && frames < 1000) {
    ++frames;
  }
  return frames;
}

TEST(Deterministic, EndsWithTheCompletePicture)
{
  // Paths beyond the cache's size meet some values that are free of interpolation error.
  for (Scenario scenario : {Scenario{}, Paths(64 << 20), SmallCache()}) {
    inr::Image image;
    const int frames = Finish(scenario, image);
    EXPECT_GT(frames, 2);
    EXPECT_LT(frames, 1000);
    scenario.deterministic = false;
    inr::Image truth;
    EXPECT_EQ(Finish(scenario, truth), 1);
    EXPECT_EQ(image.pixels, truth.pixels);
  }
}

} // namespace test::deterministic
