// SPDX-License-Identifier: BSD-3-Clause
//
// Bricks that outlive the renderer that drew them, as long as somebody keeps them.
#include "Core/Cache/KeptBricks.h"
#include "Testing/Core/Render/SharedScene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace test::kept_bricks {

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
    return Render(*this->Shown, SharedView(false)).pixels;
  }
  void forget(std::size_t step) { this->Kept[step] = nullptr; }
  std::vector<float> alone(std::size_t step) const
  {
    return DrawnAlone(this->Fields[step], SharedView(false));
  }
  std::int64_t asked() const
  {
    std::int64_t sum = 0;
    for (const CountedWaves& field : this->Fields) {
      sum += field.asked();
    }
    return sum;
  }
  const inr::Renderer& shown() const { return *this->Shown; }

private:
  inr::CacheOptions Cache;
  std::vector<CountedWaves> Fields;
  std::optional<inr::Renderer> Shown;
  std::vector<std::shared_ptr<const inr::KeptBricks>> Kept;
};

TEST(KeptBricks, OfEarlierStepsAreNotInferredAgain)
{
  Player player(SharedCache(EnoughToShare), 3);
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

TEST(KeptBricks, GoWithWhoKeepsThem)
{
  Player player(SharedCache(EnoughToShare), 2);
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

TEST(KeptBricks, OfTwoKeepersGoTogether)
{
  std::vector<std::shared_ptr<const inr::KeptBricks>> kept;
  for (int k = 0; k < 9; ++k) {
    const CountedWaves field(1 + 0.25f * static_cast<float>(k));
    inr::Renderer renderer = field.renderer(SharedCache(HalfOfASharedView));
    kept.push_back(renderer.keepBricks());
    kept.push_back(renderer.keepBricks());
    Render(renderer, SharedView(false));
    EXPECT_LE(renderer.cacheBytes(), HalfOfASharedView) << k;
  }
}

/// What was still to come for it does not take the machine from who draws next.
TEST(KeptBricks, AreNotLoadedForARendererThatHasGone)
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
  options.cache = SharedCache(EnoughToShare);
  std::optional<inr::Renderer> renderer;
  renderer.emplace(field, VolumeOf(SharedDims), inr::MacroCells(), options);
  renderer->setTransferFunction(Colours());
  const auto kept = renderer->keepBricks();
  inr::Frame frame = SharedView(false);
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

TEST(KeptBricks, MakeRoomWhereTheBudgetIsSmall)
{
  Player player(SharedCache(HalfOfASharedView), 9); // whose least needs are more than all of it
  for (std::size_t k = 0; k < 18; ++k) {
    const std::vector<float> truth = player.alone(k % 9);
    const std::int64_t asked = player.asked();
    EXPECT_EQ(player.show(k % 9), truth) << k;
    EXPECT_GT(player.asked(), asked) << k;
    EXPECT_LE(player.shown().cacheBytes(), HalfOfASharedView) << k;
  }
}

} // namespace test::kept_bricks
