// SPDX-License-Identifier: BSD-3-Clause
//
// Which bricks come first where many are missing.
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <vector>

namespace test::first_bricks {

const glm::i64vec3 Dims(70, 90, 60);

/// Frames that load a brick each, while a clock has no part in it.
class OneByOne
{
public:
  OneByOne(bool preloading, bool ranking)
      : Renderer(std::make_shared<FieldEvaluator>(Waves), VolumeOf(Dims), inr::MacroCells{},
                 OptionsOf(preloading, ranking))
  {
    this->Renderer.setTransferFunction(Colours());
  }

  inr::FrameStatistics render(inr::Frame frame)
  {
    frame.timeLimit = 0.02;
    frame.seed = ++this->Count; // else tiles wait until half of what they miss is there
    return this->Renderer.render(frame, this->Latest);
  }

  /// Root of the mean square, of the latest picture.
  double error(const inr::Image& truth) const
  {
    double sum = 0;
    for (std::size_t k = 0; k < truth.pixels.size(); ++k) {
      sum += std::pow(truth.pixels[k] - this->Latest.pixels[k], 2);
    }
    return std::sqrt(sum / static_cast<double>(truth.pixels.size()));
  }

private:
  static inr::RendererOptions OptionsOf(bool preloading, bool ranking)
  {
    inr::RendererOptions options;
    options.threads = 2;
    options.deterministic = true;
    options.cache = Options(inr::CachePrecision::Bits16, 9);
    options.cache.maximumRequests = 1;
    options.cache.preloading = preloading;
    options.cache.ranking = ranking;
    return options;
  }

  inr::Renderer Renderer;
  inr::Image Latest;
  std::uint64_t Count = 0;
};

inr::Frame TurnedView(double angle)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims));
  Turn(frame, glm::dvec3(Dims), angle);
  return frame;
}

std::vector<int> FinestLevels(bool preloading)
{
  OneByOne frames(preloading, true);
  std::vector<int> finest;
  finest.reserve(40);
  for (int k = 0; k < 40; ++k) {
    finest.push_back(frames.render(TurnedView(0)).levels.finest);
  }
  return finest;
}

TEST(FirstBricks, AreOfCoarseLevelsWherePreloadingIsOn)
{
  const std::vector<int> stepwise = FinestLevels(true);
  EXPECT_TRUE(std::is_sorted(stepwise.begin(), stepwise.end(), std::greater<int>()));
  EXPECT_EQ(std::set<int>(stepwise.begin(), stepwise.end()), (std::set<int>{0, 2, 3, 4}))
      << "level 1 is one that is passed over";
  const std::vector<int> atOnce = FinestLevels(false);
  EXPECT_EQ(std::count(atOnce.begin(), atOnce.end(), 0), 39) << "all but the first frame";
}

TEST(FirstBricks, AreThoseThatMostLightWaitsForWhereRankingIsOn)
{
  inr::Renderer whole = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Bits16, 9));
  for (const double angle : {0.0, 1.0, 2.0}) {
    SCOPED_TRACE(angle);
    const inr::Frame frame = TurnedView(angle);
    const inr::Image truth = Render(whole, frame);
    OneByOne ranked(false, true);
    OneByOne unranked(false, false);
    double hits[2] = {0, 0};
    for (int k = 0; k < 60; ++k) {
      hits[0] += ranked.render(frame).hitRate();
      hits[1] += unranked.render(frame).hitRate();
    }
    EXPECT_GT(hits[0], 2 * hits[1]);
    EXPECT_LT(ranked.error(truth), unranked.error(truth));
  }
}

} // namespace test::first_bricks
