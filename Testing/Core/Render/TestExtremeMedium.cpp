// SPDX-License-Identifier: BSD-3-Clause
//
// Transfer functions of extreme opacity, steepness and place, and rays of extreme sampling: against
// closed forms.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace test::extreme_medium {

constexpr double Length = 32; ///< of a ray through the volume, voxels
const glm::i64vec3 Dims(33, 33, 33);

float Rises(const glm::vec3& u) { return u.z; }

/// Of the ends of a ray.
constexpr double First = 0.5 / 33;
constexpr double Last = 32.5 / 33;

enum class Way { Network, Cache, ShadedNetwork, ShadedCache };

void PrintTo(Way way, std::ostream* stream)
{
  const char* const names[] = {"Network", "Cache", "ShadedNetwork", "ShadedCache"};
  *stream << names[static_cast<int>(way)];
}

class ExtremeMedium : public testing::TestWithParam<Way>
{
protected:
  bool cached() const { return this->GetParam() == Way::Cache || this->isShadedCache(); }
  bool isShadedCache() const { return this->GetParam() == Way::ShadedCache; }

  inr::Renderer renderer(const FieldEvaluator::Function& field, const inr::TransferFunction& medium,
                         const glm::i64vec3& dims = Dims) const
  {
    inr::Renderer renderer = FieldRenderer(dims, field, {}, 1, this->cached());
    renderer.setTransferFunction(medium);
    return renderer;
  }

  inr::Frame frame(double unitDistance, double step) const
  {
    inr::Frame frame = ParallelFrame(2, {4, 4}, {28, 28}, -10, 50);
    frame.unitDistance = unitDistance;
    frame.sampleDistance = step;
    frame.levelOfDetailScale = 0;
    if (this->isShadedCache() || this->GetParam() == Way::ShadedNetwork) {
      frame.shading = inr::Material{1, 0, 0, 1};
    }
    return frame;
  }

  /// Opacity of a picture's first pixel.
  double alpha(const FieldEvaluator::Function& field, const inr::TransferFunction& medium,
               double unitDistance, double step) const
  {
    inr::Renderer renderer = this->renderer(field, medium);
    return Render(renderer, this->frame(unitDistance, step)).pixels[3];
  }
};

/// Optical depth per unit of what has this opacity.
double ExtinctionOf(float opacity) { return -std::log1p(-static_cast<double>(opacity)); }

TEST_P(ExtremeMedium, OfNextToNoOpacityAddsUp)
{
  for (const float opacity : {1e-7f, 1e-5f}) {
    const double unit = Length * ExtinctionOf(opacity); // optical depth 1
    const double found = this->alpha(Waves, UniformMedium(opacity), unit, 0.5);
    EXPECT_NEAR(found, 1 - std::exp(-1), 1e-4) << opacity;
  }
}

TEST_P(ExtremeMedium, HasAnyUnitDistance)
{
  const double dense = this->alpha(Waves, UniformMedium(0.5f), 1e-6, 0.5);
  EXPECT_GE(dense, 0.999);
  EXPECT_LE(dense, 1.0);
  const double faint = this->alpha(Waves, UniformMedium(0.9999f), 1e6, 0.5);
  const double truth = -std::expm1(-Length * ExtinctionOf(0.9999f) / 1e6);
  EXPECT_NEAR(faint, truth, 0.01 * truth);
  EXPECT_EQ(this->alpha(Waves, UniformMedium(1.0f), 1e6, 0.5), 1.0);
  EXPECT_EQ(this->alpha(Waves, UniformMedium(0.0f), 1e-6, 0.5), 0.0);
}

TEST_P(ExtremeMedium, IsOfNumbersWhereSamplesAreLongerThanFloatHolds)
{
  const bool isLit = this->isShadedCache() || this->GetParam() == Way::ShadedNetwork;
  for (const auto mode : {inr::BlendMode::Composite, inr::BlendMode::Additive}) {
    inr::Renderer renderer = this->renderer(Waves, Colours());
    inr::Frame frame = Oblique(glm::dvec3(Dims), 24);
    frame.blending.mode = mode;
    frame.shading = isLit && mode == inr::BlendMode::Composite
                        ? std::optional(inr::Material{1, 0, 0, 1})
                        : std::nullopt;
    for (const double unitDistance : {1e-37, 1e-42, 1e-300}) {
      frame.unitDistance = unitDistance;
      const inr::Image picture = Render(renderer, frame);
      EXPECT_TRUE(std::all_of(picture.pixels.begin(), picture.pixels.end(), [](float value) {
        return std::isfinite(value);
      })) << unitDistance;
      EXPECT_EQ(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 1.0f);
    }
  }
}

TEST_P(ExtremeMedium, MayRiseInAStep)
{
  inr::TransferFunction step = UniformMedium(0);
  step.table.resize(std::size_t{1} << 16, step.table[0]);
  for (std::size_t k = step.table.size() / 2; k < step.table.size(); ++k) {
    step.table[k].w = 0.3f;
  }
  const double truth = 1 - std::pow(0.7, 16); // half of the way
  EXPECT_NEAR(this->alpha(Rises, step, 1, 0.01), truth, 2e-4);
}

/// Some sixteen samples of each ray hit it, from a random place on, a step h = 0.001 apart. By
/// Euler's and Maclaurin's formula their sum is off from the integral of the extinction by h^2/12
/// times the jumps of its slope, at most: with w = 33/4096 voxels to a flank and a unit distance of
/// 0.003, by 1e-6/12 (2 * 0.3 + 2 * 0.3/0.7) / w / 0.003 = 0.0050, or 0.0020 of an opacity of 0.59.
/// Places in float, 2e-6 voxels apart, move the flanks' sums by 2.4e-4, or 1e-4 of the opacity, and
/// the cache's table of opacities is 2e-4 of them off.
TEST_P(ExtremeMedium, MayHaveASpike)
{
  inr::TransferFunction spike = UniformMedium(0);
  constexpr std::size_t entries = 4097;
  spike.table.resize(entries, spike.table[0]);
  spike.table[entries / 2].w = 0.3f;
  // The mean of -ln(1 - a) for a from 0 to A, over both flanks of 1/4096 each.
  const double a = 0.3f;
  const double mean = ((1 - a) * std::log1p(-a) + a) / a;
  const double depth = 2 * mean / 4096 * 33 / 0.003;
  EXPECT_GT(depth, 0.5);
  inr::Renderer renderer = this->renderer(Rises, spike);
  inr::Frame frame = this->frame(0.003, 0.001);
  double worst = 0;
  for (frame.frameIndex = 0; frame.frameIndex < 5; ++frame.frameIndex) {
    const inr::Image picture = Render(renderer, frame);
    for (std::size_t pixel = 0; pixel < picture.pixels.size(); pixel += 4) {
      worst = std::max(worst, std::abs(picture.pixels[pixel + 3] + std::expm1(-depth)));
    }
  }
  EXPECT_LT(worst, 0.0022);
}

TEST_P(ExtremeMedium, MayHaveTenThousandEntries)
{
  inr::TransferFunction curve = UniformMedium(0);
  curve.table.clear();
  for (int k = 0; k < 10000; ++k) {
    const double x = k / 9999.0;
    curve.table.emplace_back(1, 1, 1, 0.2 * x * x);
  }
  double depth = 0;
  constexpr int pieces = 100000;
  for (int k = 0; k < pieces; ++k) {
    const double x = First + (Last - First) * (k + 0.5) / pieces;
    depth -= std::log1p(-0.2 * x * x) * Length / pieces;
  }
  EXPECT_NEAR(this->alpha(Rises, curve, 1, 0.02), 1 - std::exp(-depth), 5e-4);
}

TEST_P(ExtremeMedium, ShowsWhatIsOutsideItsRange)
{
  inr::TransferFunction function = UniformMedium(0.9f);
  function.below = glm::vec4(1, 1, 1, 0.1f);
  function.above = glm::vec4(1, 1, 1, 0.02f);
  for (const double away : {3.0, 1e6, 1e30}) {
    function.low = away;
    function.high = 2 * away;
    EXPECT_NEAR(this->alpha(Waves, function, 4, 0.5), 1 - std::pow(0.9, 8), 1e-4) << away;
    function.low = -2 * away;
    function.high = -away;
    EXPECT_NEAR(this->alpha(Waves, function, 4, 0.5), 1 - std::pow(0.98, 8), 1e-4) << away;
  }
}

/// The same picture, whatever the numbers are that the field stands for.
TEST_P(ExtremeMedium, IsTheSameForDataOfAnyRange)
{
  const auto picture = [&](double low, double width) {
    inr::VolumeInfo info = VolumeOf(Dims);
    info.low = low;
    info.high = low + width;
    inr::RendererOptions options;
    options.threads = 1;
    options.cached = this->cached();
    options.cache.bytes = 64 << 20;
    options.cache.precision = inr::CachePrecision::Float32;
    inr::Renderer renderer(std::make_shared<FieldEvaluator>(Waves), info, {}, options);
    inr::TransferFunction function = Colours();
    function.low = low + 0.25 * width;
    function.high = low + 0.75 * width;
    renderer.setTransferFunction(function);
    return Render(renderer, this->frame(1, 0.5));
  };
  const inr::Image truth = picture(0, 1);
  EXPECT_GT(truth.pixels[3], 0.1f);
  for (const glm::dvec2& range : {glm::dvec2(1e9, 1), glm::dvec2(-1e-38, 2e-38),
                                  glm::dvec2(-1e38, 2e38), glm::dvec2(-1e15, 1)}) {
    EXPECT_LT(inr::ImageMaximumError(picture(range.x, range.y), truth), 2e-5f) << range.x;
  }
}

TEST_P(ExtremeMedium, DoesNotDependOnTheStep)
{
  const double truth = 1 - std::pow(0.9, Length / 4);
  for (const double step : {1.0 / 64, 7.0, 64.0, 1e6}) {
    EXPECT_NEAR(this->alpha(Waves, UniformMedium(0.1f), 4, step), truth, 1e-4) << step;
  }
  const double half = 1 - std::pow(0.9, Length / 8);
  inr::TransferFunction ramp = OpacityRamp(0.0f);
  ramp.table = {glm::vec4(1, 1, 1, 0.1f), glm::vec4(1, 1, 1, 0.1f)};
  EXPECT_NEAR(this->alpha(Rises, ramp, 8, 1.0 / 64), half, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Ways, ExtremeMedium,
                         testing::Values(Way::Network, Way::Cache, Way::ShadedNetwork,
                                         Way::ShadedCache),
                         testing::PrintToStringParamName());

} // namespace test::extreme_medium
