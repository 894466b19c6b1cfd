// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures that make do with what the cache has room for.
#include "Core/Image/Metrics.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>

namespace test::only_what_fits {

const glm::i64vec3 Dims(90, 70, 80);
constexpr std::int64_t Enough = 64 << 20;
constexpr std::int64_t FortyBricks = 400000; ///< of more than a hundred

/// Waves, and who asked for them.
class Field : public inr::Evaluator
{
public:
  explicit Field(const glm::i64vec3& resolution) : Resolution(resolution) {}

  void evaluate(const glm::vec3* positions, std::int64_t count, float* values) const override
  {
    this->Points += count;
    for (std::int64_t k = 0; k < count; ++k) {
      values[k] = Waves(positions[k]);
    }
  }
  void evaluateGrid(const std::vector<float> (&axes)[3], float* values) const override
  {
    this->Voxels += static_cast<std::int64_t>(axes[0].size() * axes[1].size() * axes[2].size());
    for (const float z : axes[2]) {
      for (const float y : axes[1]) {
        for (const float x : axes[0]) {
          *values++ = Waves({x, y, z});
        }
      }
    }
  }
  glm::i64vec3 resolution() const override { return this->Resolution; }
  std::string kernel() const override { return "field"; }

  mutable std::atomic<std::int64_t> Points{0}; ///< of paths
  mutable std::atomic<std::int64_t> Voxels{0}; ///< of bricks, and what they are made of

private:
  glm::i64vec3 Resolution;
};

struct Scene
{
  Scene(inr::RenderMode mode, std::int64_t bytes, bool onlyWhatFits,
        const glm::i64vec3& resolution = glm::i64vec3(0))
      : field(std::make_shared<Field>(resolution)),
        renderer(this->field, VolumeOf(Dims), {}, RendererOptions(bytes, onlyWhatFits)),
        frame(Oblique(glm::dvec3(Dims), 80))
  {
    this->renderer.setTransferFunction(Colours());
    this->frame.mode = mode;
    this->frame.samplesPerPixel = 2;
  }

  static inr::RendererOptions RendererOptions(std::int64_t bytes, bool onlyWhatFits)
  {
    inr::RendererOptions options;
    options.threads = 2;
    options.cache = Options(inr::CachePrecision::Bits16, 16);
    options.cache.background = false; // or more comes in after a picture is complete
    options.cache.bytes = bytes;
    options.cache.onlyWhatFits = onlyWhatFits;
    return options;
  }

  std::vector<float> render()
  {
    this->statistics = this->renderer.render(this->frame, this->image);
    return this->image.pixels;
  }

  std::shared_ptr<Field> field;
  inr::Renderer renderer;
  inr::Frame frame;
  inr::Image image;
  inr::FrameStatistics statistics;
};

class OnlyWhatFits : public testing::TestWithParam<inr::RenderMode>
{};

TEST_P(OnlyWhatFits, IsTheWholePictureWhereAllFits)
{
  Scene whole(GetParam(), Enough, false);
  Scene fitting(GetParam(), Enough, true);
  EXPECT_EQ(fitting.render(), whole.render());
  EXPECT_TRUE(fitting.statistics.complete);
  EXPECT_EQ(fitting.statistics.missed, 0);
}

TEST_P(OnlyWhatFits, InfersNoMoreThanFits)
{
  Scene whole(GetParam(), FortyBricks, false);
  const inr::Image truth = (whole.render(), whole.image);
  Scene fitting(GetParam(), FortyBricks, true);
  const std::vector<float> pixels = fitting.render();
  EXPECT_TRUE(fitting.statistics.complete);
  EXPECT_GT(fitting.statistics.missed, 0);
  EXPECT_LT(fitting.statistics.missed, fitting.statistics.samples);
  EXPECT_EQ(fitting.field->Points, 0);
  const std::int64_t asked = fitting.field->Voxels;
  // A voxel above the finest level is made of eight.
  EXPECT_LT(asked, 2 * fitting.renderer.cachedBricks() * 16 * 16 * 16 * 8);
  const bool traces = GetParam() == inr::RenderMode::PathTracing; // or the cost is in bricks
  EXPECT_GT(traces ? whole.field->Points : whole.field->Voxels, traces ? 0 : asked);
  // It is the same picture, less sharp.
  const double psnr = inr::ImagePsnr(fitting.image, truth);
  EXPECT_GT(psnr, 15);
  EXPECT_LT(psnr, 60);
  // And all that there is for this view.
  fitting.frame.frameIndex = 1;
  fitting.render();
  fitting.frame.frameIndex = 0;
  EXPECT_LT(fitting.field->Voxels, asked + asked / 4);
}

/// Whichever level is left out on the way: it takes the place of the next finer one that does not
/// fit.
TEST_P(OnlyWhatFits, ShowsAsMuchOfAFieldOfKnownResolution)
{
  double psnr[2];
  for (const bool isKnown : {false, true}) {
    const glm::i64vec3 resolution = isKnown ? Dims : glm::i64vec3(0);
    Scene whole(GetParam(), Enough, false, resolution);
    Scene fitting(GetParam(), FortyBricks / 3, true, resolution);
    whole.render();
    fitting.render();
    psnr[isKnown] = inr::ImagePsnr(fitting.image, whole.image);
  }
  EXPECT_GT(psnr[1], psnr[0] - 1.0);
}

TEST_P(OnlyWhatFits, FramesInALimitedTimeEnd)
{
  Scene scene(GetParam(), FortyBricks, true);
  scene.frame.timeLimit = 0.004;
  std::vector<float> last;
  int frames = 0;
  do {
    last = scene.render();
    ++frames;
  } while (!scene.statistics.complete && frames < 3000);
  EXPECT_GT(frames, 1);
  EXPECT_TRUE(scene.statistics.complete);
  EXPECT_GT(scene.statistics.missed, 0);
  const std::int64_t asked = scene.field->Voxels;
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(scene.render(), last);
    EXPECT_TRUE(scene.statistics.complete);
  }
  EXPECT_EQ(scene.field->Voxels, asked);
  EXPECT_EQ(scene.field->Points, 0);
}

TEST_P(OnlyWhatFits, TakesWhatAnotherViewLeaves)
{
  Scene scene(GetParam(), FortyBricks, true);
  scene.render();
  const std::int64_t first = scene.field->Voxels;
  Turn(scene.frame, glm::dvec3(Dims), 2.2);
  scene.frame.clippingPlanes = {glm::dvec4(1, 0, 0, -80), glm::dvec4(0, 1, 0, -40)}; // fits
  Scene whole(GetParam(), Enough, false);
  whole.frame = scene.frame;
  EXPECT_EQ(scene.render(), whole.render());
  EXPECT_GT(scene.field->Voxels, first);
  EXPECT_EQ(scene.statistics.missed, 0);
}

INSTANTIATE_TEST_SUITE_P(Modes, OnlyWhatFits,
                         testing::Values(inr::RenderMode::RayMarching,
                                         inr::RenderMode::PathTracing),
                         [](const auto& info) {
                           const bool marches = info.param == inr::RenderMode::RayMarching;
                           return std::string(marches ? "RayMarching" : "PathTracing");
                         });

} // namespace test::only_what_fits
