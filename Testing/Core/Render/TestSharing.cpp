// SPDX-License-Identifier: BSD-3-Clause
//
// Several renderers in a process: what they share, and that none sees it in its pictures.
#include "Core/Error.h"
#include "Testing/Core/RandomModel.h"
#include "Testing/Core/Render/VoxelScene.h"

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

namespace {

const glm::i64vec3 Dims(90, 70, 80);

/// Waves of some length, and how many values of them were asked for.
class Field
{
public:
  explicit Field(float length) : Asked(std::make_shared<std::atomic<std::int64_t>>(0))
  {
    this->Values = std::make_shared<FieldEvaluator>([asked = this->Asked, length](glm::vec3 u) {
      ++*asked;
      return Waves(u * length);
    });
  }
  std::int64_t asked() const { return *this->Asked; }

  inr::Renderer renderer(const inr::CacheOptions& cache, int threads = 1) const
  {
    inr::RendererOptions options;
    options.threads = threads;
    options.cache = cache;
    inr::Renderer renderer(this->Values, VolumeOf(Dims), {}, options);
    renderer.setTransferFunction(Colours());
    return renderer;
  }

private:
  std::shared_ptr<std::atomic<std::int64_t>> Asked;
  std::shared_ptr<const inr::Evaluator> Values;
};

inr::CacheOptions Cache(std::int64_t bytes, bool background = true)
{
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
  options.bytes = bytes;
  options.background = background;
  return options;
}

/// The volume from one side or, a little larger, from the other.
inr::Frame View(bool other)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 24);
  if (other) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 2.2, glm::dvec3(0, 1, 0));
    const glm::dmat4 center = glm::translate(glm::dmat4(1.0), 0.5 * glm::dvec3(Dims));
    frame.clipToWorld = center * turn * glm::inverse(center) * frame.clipToWorld;
    frame.clipToWorld[0] *= 0.9;
  }
  return frame;
}

constexpr std::int64_t Enough = 64 << 20;
constexpr std::int64_t HalfOfAView = 500000; ///< some fifty bricks

std::vector<float> Alone(const Field& field, inr::Frame frame)
{
  frame.timeLimit = 0;
  inr::Renderer renderer = field.renderer(Cache(Enough, false));
  return Render(renderer, frame).pixels;
}

TEST(Sharing, ABrickIsInferredOnceForAllViewsOfAVolume)
{
  const Field field(1);
  inr::Renderer first = field.renderer(Cache(Enough));
  inr::Frame part = View(false);
  part.clippingPlanes = {glm::dvec4(-1, 0, 0, 30)};
  const inr::Image image = Render(first, part);
  const std::int64_t asked = field.asked();
  const std::int64_t bytes = first.cacheBytes();
  inr::Renderer second = field.renderer(Cache(Enough), 2);
  EXPECT_EQ(Render(second, part).pixels, image.pixels);
  EXPECT_EQ(field.asked(), asked);
  EXPECT_EQ(second.cacheBytes(), bytes);
  EXPECT_EQ(second.cachedBricks(), first.cachedBricks());
  { // what it brings is there for the first
    const std::vector<float> other = Render(second, View(true)).pixels;
    EXPECT_GT(field.asked(), asked);
    const std::int64_t all = field.asked();
    second = field.renderer(Cache(Enough));
    EXPECT_EQ(Render(first, View(true)).pixels, other);
    EXPECT_EQ(field.asked(), all);
  }
}

TEST(Sharing, BricksOutliveARendererThatIsReplaced)
{
  const Field field(1);
  inr::Renderer renderer = field.renderer(Cache(Enough));
  Render(renderer, View(false));
  const std::int64_t bricks = renderer.cachedBricks();
  const std::int64_t asked = field.asked();
  inr::CacheOptions others = Cache(Enough);
  others.ranking = !others.ranking;
  others.preloading = !others.preloading;
  others.maximumRequests = 7;
  renderer = field.renderer(others, 2);
  EXPECT_EQ(renderer.cachedBricks(), bricks);
  Render(renderer, View(false));
  EXPECT_EQ(field.asked(), asked);
}

/// Voxels of few bits are rounded over the ranges of the cells.
TEST(Sharing, OfOneFieldButNotOfTwoSetsOfRanges)
{
  const auto field =
      std::make_shared<FieldEvaluator>([](const glm::vec3& u) { return 0.5f + 0.004f * Waves(u); });
  inr::MacroCells wide = inr::MakeMacroCells(Dims, 16);
  wide.provenance = inr::MacroCellProvenance::Training;
  std::fill(wide.ranges.begin(), wide.ranges.end(), inr::ValueRange{0.0f, 1.0f});
  inr::RendererOptions options;
  options.threads = 1;
  options.cache = Cache(Enough, false);
  options.cache.precision = inr::CachePrecision::Bits8;
  const auto drawn = [&](const inr::MacroCells& cells) {
    inr::Renderer renderer(field, VolumeOf(Dims), cells, options);
    inr::TransferFunction colours = Colours();
    colours.low = 0.495;
    colours.high = 0.505;
    renderer.setTransferFunction(colours);
    return Render(renderer, View(false)).pixels;
  };
  const std::vector<float> alone = drawn({});
  const inr::Renderer other(field, VolumeOf(Dims), wide, options);
  EXPECT_EQ(drawn({}), alone);
  EXPECT_NE(drawn(wide), alone);
}

TEST(Sharing, OfOneModelButNotOfTwo)
{
  const auto model = RandomModel(SmallDescription());
  model->volume.dims = Dims;
  const auto copy = std::make_shared<inr::Model>(*model);
  inr::RendererOptions options;
  options.cache = Cache(Enough);
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
void Alternate(const Field& a, const Field& b, const inr::Frame (&frames)[2], std::int64_t bytes)
{
  inr::Renderer renderers[2] = {a.renderer(Cache(bytes)), b.renderer(Cache(bytes))};
  inr::Image images[2];
  bool complete[2] = {false, false};
  for (int k = 0; k < 20000 && !(complete[0] && complete[1]); ++k) {
    for (const int at : {0, 1}) {
      complete[at] = renderers[at].render(frames[at], images[at]).complete;
      ASSERT_LE(renderers[at].cacheBytes(), bytes);
    }
  }
  EXPECT_TRUE(complete[0] && complete[1]);
  EXPECT_TRUE(images[0].pixels == Alone(a, frames[0]));
  EXPECT_TRUE(images[1].pixels == Alone(b, frames[1]));
}

class SharingInTurns : public testing::TestWithParam<double>
{
protected:
  void alternate(const inr::Frame& like, std::int64_t bytes)
  {
    inr::Frame frames[2] = {View(false), View(true)};
    for (inr::Frame& frame : frames) {
      frame.mode = like.mode;
      frame.shading = like.shading;
      frame.lights = like.lights;
      frame.samplesPerPixel = like.samplesPerPixel;
      frame.timeLimit = GetParam();
    }
    const Field a(1);
    const Field b(0.7f);
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

TEST_P(SharingInTurns, EachHasItsPictureWhereBothFit) { this->alternate({}, Enough); }

TEST_P(SharingInTurns, EachHasItsPictureWhereNoneFits) { this->alternate({}, HalfOfAView); }

TEST_P(SharingInTurns, EachHasItsPictureWhereOneFitsButNotBoth)
{
  const Field field(1);
  std::int64_t bytes = 0;
  {
    inr::Renderer alone = field.renderer(Cache(Enough, false));
    Render(alone, View(true));
    bytes = alone.cacheBytes();
  }
  this->alternate({}, bytes * 3 / 2);
}

TEST_P(SharingInTurns, EachHasItsShadedPicture)
{
  inr::Frame lit;
  lit.shading = inr::Material{};
  lit.lights.resize(1);
  this->alternate(lit, HalfOfAView);
}

TEST(Sharing, PathsComeToAnEndWhateverTheOtherTakes)
{
  const Field fields[2] = {Field(1), Field(0.7f)};
  inr::Frame frame = View(false);
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 2;
  const std::vector<float> truth[2] = {Alone(fields[0], frame), Alone(fields[1], frame)};
  for (const double timeLimit : {0.0, 1e-9, 0.002}) {
    frame.timeLimit = timeLimit;
    for (const std::int64_t bytes : {Enough, 2 * HalfOfAView}) {
      inr::Renderer renderers[2] = {fields[0].renderer(Cache(bytes)),
                                    fields[1].renderer(Cache(bytes))};
      bool complete[2] = {false, false};
      inr::Image images[2];
      for (int k = 0; k < 20000 && !(complete[0] && complete[1]); ++k) {
        complete[0] = renderers[0].render(frame, images[0]).complete;
        complete[1] = renderers[1].render(frame, images[1]).complete;
      }
      EXPECT_TRUE(complete[0] && complete[1]);
      if (bytes == Enough) {
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
  const Field field(1);
  inr::Renderer renderer = field.renderer(Cache(HalfOfAView, false));
  inr::Frame frames[] = {View(false), View(true)};
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
    EXPECT_EQ(images[k].pixels, Alone(field, frames[k])) << k;
  }
  frames[0].timeLimit = 1e-9; // finished ones are only shown
  EXPECT_EQ(renderer.render(frames[0], images[0]).work.bricks.bricks, 0);
}

TEST(Sharing, ASmallCacheBesideALargeOneCompletesItsPicture)
{
  const Field fields[2] = {Field(1), Field(0.7f)};
  inr::Renderer large = fields[0].renderer(Cache(Enough));
  inr::Renderer small = fields[1].renderer(Cache(HalfOfAView));
  Render(large, View(false));
  EXPECT_EQ(Render(small, View(false)).pixels, Alone(fields[1], View(false)));
  EXPECT_LE(large.cacheBytes(), Enough);
  EXPECT_GT(large.cacheBytes(), 2 * HalfOfAView);
}

TEST(Sharing, AnotherMayRenderOrGoInTheMiddleOfAPicture)
{
  const Field fields[2] = {Field(1), Field(0.7f)};
  const std::int64_t bytes = HalfOfAView;
  inr::Renderer renderer = fields[0].renderer(Cache(bytes));
  auto other = std::make_unique<inr::Renderer>(fields[1].renderer(Cache(bytes)));
  inr::Renderer same = fields[0].renderer(Cache(bytes));
  inr::Image image;
  inr::Frame soon = View(true);
  soon.timeLimit = 1e-9;
  other->render(soon, image); // and now bricks are on their way
  int step = 0;
  const auto self = std::this_thread::get_id();
  const auto keepGoing = [&] {
    if (std::this_thread::get_id() == self) {
      inr::Image within;
      ++step;
      if (step == 2) {
        EXPECT_EQ(Render(*other, View(true)).pixels, Alone(fields[1], View(true)));
        EXPECT_THROW(same.render(View(true), within), inr::Error);
      } else if (step == 3) {
        other.reset();
      }
    }
    return true;
  };
  renderer.render(View(false), image, nullptr, keepGoing);
  EXPECT_GE(step, 3);
  EXPECT_EQ(image.pixels, Alone(fields[0], View(false)));
  EXPECT_EQ(Render(same, View(true)).pixels, Alone(fields[0], View(true)));
}

/// A host is asked on the renderer's threads, too: what renders there would wait for ever.
TEST(Sharing, AnotherIsRefusedInTheMiddleOnAnyThread)
{
  const Field field(1);
  inr::Renderer renderer = field.renderer(Cache(HalfOfAView), 4);
  inr::Renderer same = field.renderer(Cache(HalfOfAView), 4);
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
      same.render(View(true), within);
    } catch (const inr::Error& error) {
      refused += error.code() == inr::ErrorCode::Cancelled ? 1 : 0;
    }
    return true;
  };
  inr::Image image;
  renderer.render(View(false), image, nullptr, keepGoing);
  EXPECT_GT(refused, 1);
  EXPECT_EQ(image.pixels, Alone(field, View(false)));
  if (!elsewhere) {
    GTEST_SKIP() << "there is no other thread on this machine";
  }
}

/// One that comes in the midst of a picture may leave it less room than it already uses.
TEST(Sharing, OneThatComesInTheMidstTakesRoom)
{
  const Field fields[2] = {Field(1), Field(0.7f)};
  for (const inr::RenderMode mode : {inr::RenderMode::RayMarching, inr::RenderMode::PathTracing}) {
    inr::Renderer renderer = fields[0].renderer(Cache(HalfOfAView));
    for (int k = 0; k < 20; ++k) {
      inr::Frame frame = View(false);
      frame.mode = mode;
      frame.clipToWorld[0][0] *= 1 + 0.003 * k;
      frame.timeLimit = k <= 4 ? 0 : 1e-9;
      std::optional<inr::Renderer> other;
      const auto come = [&] {
        if (!other && k > 4) {
          other.emplace(fields[1].renderer(Cache(HalfOfAView)));
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
  const Field fields[2] = {Field(1), Field(0.7f)};
  const std::vector<float> truth[2] = {Alone(fields[0], View(false)),
                                       Alone(fields[1], View(false))};
  std::atomic<std::int64_t> most{0};
  const auto work = [&](std::size_t seed) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = (seed + k) % 2;
      inr::Renderer renderer = fields[at].renderer(Cache(HalfOfAView));
      inr::Frame frame = View(false);
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
  EXPECT_LE(most, HalfOfAView + tables);
}

/// Plays the steps of a series: each in a renderer of its own, of which the bricks are kept.
class Player
{
public:
  explicit Player(const inr::CacheOptions& cache, std::size_t steps) : Cache(cache), Kept(steps)
  {
    for (std::size_t k = 0; k < steps; ++k) {
      this->Fields.emplace_back(1 + 0.25f * static_cast<float>(k));
    }
  }

  std::vector<float> show(std::size_t step)
  {
    inr::Renderer next = this->Fields[step].renderer(this->Cache);
    this->Kept[step] = next.keepBricks();
    this->Shown.emplace(std::move(next));
    return Render(*this->Shown, View(false)).pixels;
  }
  void forget(std::size_t step) { this->Kept[step] = nullptr; }
  std::vector<float> alone(std::size_t step) const
  {
    return Alone(this->Fields[step], View(false));
  }
  std::int64_t asked() const
  {
    std::int64_t sum = 0;
    for (const Field& field : this->Fields) {
      sum += field.asked();
    }
    return sum;
  }
  const inr::Renderer& shown() const { return *this->Shown; }

private:
  inr::CacheOptions Cache;
  std::vector<Field> Fields;
  std::optional<inr::Renderer> Shown;
  std::vector<std::shared_ptr<const inr::KeptBricks>> Kept;
};

TEST(Sharing, KeptBricksOfEarlierStepsAreNotInferredAgain)
{
  Player player(Cache(Enough), 3);
  std::vector<std::vector<float>> first;
  for (std::size_t k = 0; k < 3; ++k) {
    first.push_back(player.show(k));
  }
  EXPECT_NE(first[0], first[1]);
  const std::int64_t asked = player.asked();
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(player.show(k), first[k]) << k;
  }
  EXPECT_EQ(player.asked(), asked);
}

TEST(Sharing, KeptBricksGoWithWhoKeepsThem)
{
  Player player(Cache(Enough), 2);
  player.show(0);
  const std::int64_t alone = player.shown().cacheBytes();
  player.show(1);
  const std::int64_t both = player.shown().cacheBytes();
  EXPECT_GT(both, alone + alone / 2);
  player.forget(0);
  EXPECT_LT(player.shown().cacheBytes(), both - alone / 2);
  const std::int64_t asked = player.asked();
  player.show(0);
  EXPECT_GT(player.asked(), asked);
}

TEST(Sharing, BricksThatTwoKeepGoTogether)
{
  std::vector<std::shared_ptr<const inr::KeptBricks>> kept;
  for (int k = 0; k < 9; ++k) {
    const Field field(1 + 0.25f * static_cast<float>(k));
    inr::Renderer renderer = field.renderer(Cache(HalfOfAView));
    kept.push_back(renderer.keepBricks());
    kept.push_back(renderer.keepBricks());
    Render(renderer, View(false));
    EXPECT_LE(renderer.cacheBytes(), HalfOfAView) << k;
  }
}

/// What was still to come for it does not take the machine from who draws next.
TEST(Sharing, NothingIsLoadedForARendererThatHasGone)
{
  using std::chrono::milliseconds;
  const auto asked = std::make_shared<std::atomic<std::int64_t>>(0);
  const auto field = std::make_shared<FieldEvaluator>([asked](const glm::vec3& u) {
    if (++*asked % 64 == 0) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
    return Waves(u);
  });
  inr::RendererOptions options;
  options.threads = 1;
  options.cache = Cache(Enough);
  std::optional<inr::Renderer> renderer;
  renderer.emplace(field, VolumeOf(Dims), inr::MacroCells(), options);
  renderer->setTransferFunction(Colours());
  const auto kept = renderer->keepBricks();
  inr::Frame frame = View(false);
  frame.timeLimit = 0.01;
  inr::Image image;
  ASSERT_FALSE(renderer->render(frame, image).complete);
  const auto askedIn = [&](milliseconds time) {
    const std::int64_t before = *asked;
    std::this_thread::sleep_for(time);
    return *asked - before;
  };
  for (int tries = 0; tries < 1000 && askedIn(milliseconds(20)) == 0; ++tries) {
  }
  const std::int64_t before = *asked;
  renderer.reset();
  while (askedIn(milliseconds(100)) > 0) {
  }
  constexpr std::int64_t brick = 16 * 16 * 16 * 8; // points, of a coarse one
  EXPECT_LE(*asked - before, brick);               // what was begun comes to its end
}

TEST(Sharing, KeptBricksMakeRoomWhereTheBudgetIsSmall)
{
  Player player(Cache(HalfOfAView), 9); // whose least needs are more than all of it
  for (std::size_t k = 0; k < 18; ++k) {
    const std::vector<float> truth = player.alone(k % 9);
    const std::int64_t asked = player.asked();
    EXPECT_EQ(player.show(k % 9), truth) << k;
    EXPECT_GT(player.asked(), asked) << k;
    EXPECT_LE(player.shown().cacheBytes(), HalfOfAView) << k;
  }
}

} // namespace
