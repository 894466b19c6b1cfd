// SPDX-License-Identifier: BSD-3-Clause
//
// Paths through media whose light is known in closed form, and what a picture may depend on.
#include "Core/Error.h"
#include "Core/Render/Scene/FrameCheck.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/Render/PathScene.h"

#include <glm/vector_relational.hpp>

namespace test::path_tracing {

/// Exact ranges of a field that equals u.z.
inr::MacroCells RampCells(const glm::i64vec3& dims)
{
  inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) {
    const auto layer = static_cast<std::int64_t>(k) / (cells.dims.x * cells.dims.y);
    cells.ranges[k] = {static_cast<float>(static_cast<double>(layer) * cells.spacing.z),
                       static_cast<float>(static_cast<double>(layer + 1) * cells.spacing.z)};
  }
  return cells;
}

float Ramp(const glm::vec3& u) { return u.z; }

/// A cloud that varies in every direction.
float Cloud(const glm::vec3& u)
{
  return 0.5f + 0.5f * std::sin(9.0f * u.x) * std::cos(7.0f * u.y + 2.0f * u.z);
}

TEST(PathTracing, ConservesTheLightOfAWhiteFurnace)
{
  for (const double anisotropy : {-0.5, 0.0, 0.8}) {
    for (const float top : {0.05f, 0.9f, 1.0f}) {
      PathTest test({17, 17, 17}, Cloud, OpacityRamp(top));
      test.options.anisotropy = anisotropy;
      test.options.maximumBounces = 1 << 30;
      test.options.ambientLight = {0.75f, 0.5f, 0.25f};
      const inr::Image image = test.picture(3);
      for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
        const float alpha = image.pixels[k + 3];
        EXPECT_EQ(image.pixels[k], 0.75f * alpha);
        EXPECT_EQ(image.pixels[k + 1], 0.5f * alpha);
        EXPECT_EQ(image.pixels[k + 2], 0.25f * alpha);
      }
    }
  }
}

TEST(PathTracing, AlphaOfAHomogeneousMediumFollowsBeerAndLambert)
{
  PathTest test({17, 17, 17}, Constant, UniformMedium(0.1f));
  test.frame.unitDistance = 2;
  EXPECT_LT(std::abs(test.estimate(3, 40).z(1.0 - std::pow(0.9, 16.0 / 2))), Unlikely);
}

TEST(PathTracing, AlphaOfALinearMediumMatchesTheIntegral)
{
  // ln(1 - 0.2 u) integrated along z from 0.5/65 to 64.5/65, over a length of 64.
  const auto integral = [](double u) {
    const double rest = 1.0 - 0.2 * u;
    return -(rest * std::log(rest) - rest) / 0.2;
  };
  const double depth = (integral(64.5 / 65) - integral(0.5 / 65)) * 65;
  for (const bool cells : {false, true}) {
    PathTest test({65, 65, 65}, Ramp, OpacityRamp(0.2f),
                  cells ? RampCells({65, 65, 65}) : inr::MacroCells{});
    test.frame = ParallelFrame(32, {4, 4}, {60, 60}, -10, 80);
    test.frame.unitDistance = 5;
    test.options.emissionOnly = true;
    EXPECT_LT(std::abs(test.estimate(3, 300).z(1.0 - std::exp(depth / 5))), Unlikely) << cells;
    EXPECT_EQ(test.statistics.clamped, 0);
  }
}

TEST(PathTracing, DistancesAreTheWorlds)
{
  PathTest test({9, 17, 33}, Constant, UniformMedium(0.1f));
  // Spacing 5, 2, 0.5 and a shear that moves x along with z.
  test.frame = ParallelFrame(32, {14, 8}, {26, 24}, -10, 50);
  glm::dmat4 indexToWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(5, 2, 0.5));
  indexToWorld[2].x = 0.1;
  test.frame.worldToIndex = glm::inverse(indexToWorld);
  test.frame.unitDistance = 4;
  EXPECT_LT(std::abs(test.estimate(3, 40).z(1.0 - std::pow(0.9, 16.0 / 4))), Unlikely);
}

TEST(PathTracing, InnerRaysAreMeasuredAndClippedInTheWorld)
{
  inr::Frame frame = ParallelFrame(1, {0, 0}, {1, 1}, -10, 50);
  glm::dmat4 indexToWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(5, 2, 0.5));
  indexToWorld[2].x = 0.25;
  frame.worldToIndex = glm::inverse(indexToWorld);
  const glm::dvec3 from(3, 4, 10);
  const glm::dvec3 start(17.5, 8, 5);
  const glm::i64vec3 dims(9, 17, 33);
  const auto end = [&](const glm::dvec3& direction, double limit) {
    std::vector<glm::dvec4> planes;
    const inr::InnerRays inner(frame, inr::RayGeometry(frame, dims), dims, planes);
    const inr::Ray ray = inner.ray(from, direction, limit);
    return inner.world(ray.at(ray.length));
  };
  const glm::dvec3 diagonal = glm::normalize(glm::dvec3(1, -2, 0.5));
  EXPECT_LT(glm::distance(end(diagonal, 3), start + 3.0 * diagonal), 1e-12);
  EXPECT_LT(glm::distance(end({0, 1, 0}, 1e9), {17.5, 32, 5}), 1e-12);
  frame.clippingPlanes = {{0, -1, 0, 12}}; // y <= 12
  EXPECT_LT(glm::distance(end({0, 1, 0}, 1e9), {17.5, 12, 5}), 1e-12);
  EXPECT_LT(glm::distance(end({0, -1, 0}, 1e9), {17.5, 0, 5}), 1e-12);
  frame.worldToMedium = glm::dmat3(2, 0.5, 0, 0, 1, 0, 0, 0, 0.25); // lights stay where they are
  EXPECT_LT(glm::distance(end(diagonal, 3), start + 3.0 * diagonal), 1e-12);
}

TEST(PathTracing, InnerRaysCountLengthsOfTheMedium)
{
  inr::Frame frame = ParallelFrame(1, {0, 0}, {1, 1}, -10, 50);
  frame.worldToIndex = glm::inverse(glm::scale(glm::dmat4(1.0), glm::dvec3(5, 2, 0.5)));
  frame.worldToMedium = glm::dmat3(2, 0.5, 0, 0, 1, 0.3, 0.7, 0, 0.25);
  const glm::i64vec3 dims(9, 17, 33);
  std::vector<glm::dvec4> planes;
  const inr::RayGeometry geometry(frame, dims);
  const inr::InnerRays inner(frame, geometry, dims, planes);
  for (const glm::dvec3& along : {glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 1), glm::dvec3(-2, 1, 3)}) {
    const inr::Ray ray = inner.ray({3, 4, 10}, glm::normalize(along));
    const glm::dvec3 way = inner.world(ray.at(ray.length)) - inner.world(ray.at(0));
    const double length = glm::length(frame.worldToMedium * way);
    ASSERT_GT(length, 1);
    EXPECT_NEAR(ray.length * geometry.lengthPerUnit() / length, 1, 1e-12);
  }
}

/// Extinction 0.2 per world length, and a light that shines against the view: what a path scatters
/// once towards the camera has the same way behind it wherever that happened.
struct LitFromBehind : PathTest
{
  LitFromBehind()
      : PathTest({17, 17, 17}, Constant, UniformMedium(static_cast<float>(1 - std::exp(-0.2))))
  {
    inr::Light light;
    light.direction = {0, 0, -3};
    this->lights = {light};
    this->options.maximumBounces = 1;
  }
};

TEST(PathTracing, ClippingPlanesClipPathsAndTheirLight)
{
  LitFromBehind test;
  test.frame.clippingPlanes = {{0, 0, -1, 8}}; // z <= 8
  EXPECT_LT(std::abs(test.estimate(3, 40).z(1.0 - std::exp(-0.2 * 8))), Unlikely);
  EXPECT_LT(std::abs(test.estimate(0, 40).z(0.25 * 0.2 * 8 * std::exp(-0.2 * 8))), Unlikely);
}

TEST(PathTracing, OpaqueDepthStopsPrimaryRaysOnly)
{
  LitFromBehind test;
  const std::vector<float> depth(32 * 32, (4.0f + 10.0f) / 60.0f); // at z = 4
  test.frame.opaqueDepth = depth.data();
  EXPECT_LT(std::abs(test.estimate(3, 40).z(1.0 - std::exp(-0.2 * 4))), Unlikely);
  EXPECT_LT(std::abs(test.estimate(0, 40).z(0.25 * 0.2 * 4 * std::exp(-0.2 * 16))), Unlikely);
}

TEST(PathTracing, EmissionAndAbsorptionMakeTheMarchersPicture)
{
  const glm::i64vec3 dims(33, 33, 33);
  inr::TransferFunction medium;
  medium.table = {{1, 0, 0, 0}, {0, 1, 0, 0.05f}, {0, 0.5f, 1, 0.2f}};
  inr::Renderer renderer = FieldRenderer(dims, Cloud);
  renderer.setTransferFunction(medium);
  PathTest test(dims, Cloud, medium);
  test.frame = ParallelFrame(12, {-2, -2}, {34, 34}, -10, 80);
  test.options.emissionOnly = true;
  test.options.ambientLight = glm::vec3(1.0f); // which must not show
  test.frame.clipToWorld = glm::rotate(glm::dmat4(1.0), 0.3, glm::dvec3(0, 1, 0.2)) *
                           test.frame.clipToWorld; // across the cells
  test.frame.sampleDistance = 0.05;
  test.frame.adaptiveSampling = false;
  const inr::Image truth = Render(renderer, test.frame);
  constexpr int frames = 1500;
  std::vector<double> sum(truth.pixels.size());
  std::vector<double> squares(truth.pixels.size());
  for (int k = 0; k < frames; ++k) {
    const inr::Image image = test.picture(static_cast<std::uint64_t>(k));
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += image.pixels[i];
      squares[i] += static_cast<double>(image.pixels[i]) * image.pixels[i];
    }
  }
  // The marcher stops at 99.9 % opacity and its steps have an error of their own.
  constexpr double marched = 2e-3;
  double chiSquare = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / frames;
    const double variance = (squares[i] / frames - mean * mean) / frames;
    const double difference = mean - truth.pixels[i];
    if (truth.pixels[i] == 0.0f) {
      EXPECT_EQ(mean, 0.0) << i;
    }
    EXPECT_LT(std::abs(difference), 6.0 * std::sqrt(variance) + marched) << i;
    chiSquare += difference * difference / (variance + marched * marched);
  }
  // Four channels of a pixel go together: 144 independent ones, variance at most 4 * 4 * 2 * 144.
  EXPECT_LT(chiSquare, 576.0 + Unlikely * std::sqrt(32.0 * 144));
}

TEST(PathTracing, ThreadsAndTilesDoNotShow)
{
  const auto render = [](int edge, std::uint64_t frameIndex) {
    PathTest test({17, 17, 17}, Cloud, OpacityRamp(0.4f));
    test.options.ambientLight = glm::vec3(0.5f);
    test.lights = {inr::Light{}};
    return test.picture(frameIndex, edge).pixels;
  };
  const std::vector<float> whole = render(32, 5);
  EXPECT_EQ(whole, render(16, 5));
  EXPECT_EQ(whole, render(5, 5));
  EXPECT_EQ(whole, render(1, 5));
  EXPECT_NE(whole, render(32, 6));
}

/// Notes the points it is asked for; the field is 0.5.
class RecordingSampler : public inr::FieldSampler
{
public:
  void sample(const inr::FieldPoint* points, std::int64_t count, float* values) override
  {
    this->asked.insert(this->asked.end(), points, points + count);
    std::fill_n(values, count, 0.5f);
  }

  std::vector<inr::FieldPoint> asked;
};

TEST(PathTracing, PointsAreInsideAndAtThePixelsLevel)
{
  PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
  test.frame = ParallelFrame(4, {4, 4}, {12, 12}, -10, 50); // pixels two voxels wide
  const inr::RayGeometry geometry(test.frame, test.dims);
  for (const int levels : {1, 4}) {
    const inr::PathTracer tracer(test.frame, geometry, test.dims, test.majorants,
                                 test.colors.lookup(), levels);
    RecordingSampler sampler;
    inr::Image rgba(4, 4, 4);
    const inr::FrameStatistics statistics = tracer.trace({0, 0, 4, 4}, sampler, rgba);
    EXPECT_EQ(statistics.samples, static_cast<std::int64_t>(sampler.asked.size()));
    EXPECT_GT(statistics.samples, 32); // scattered paths among them
    for (const inr::FieldPoint& point : sampler.asked) {
      EXPECT_EQ(point.level, levels == 1 ? 0 : 1);
      const glm::vec3 index = glm::vec3(point.voxel) + point.fraction;
      EXPECT_TRUE(glm::all(glm::greaterThanEqual(index, glm::vec3(0.0f))));
      EXPECT_TRUE(glm::all(glm::lessThanEqual(index, glm::vec3(16.0f))));
    }
  }
}

TEST(PathTracing, PointsKeepTheirDigitsInHugeVolumes)
{
  const inr::FieldPoint point = inr::MakeFieldPoint({131070.0 + 0x1p-20, 0.25, 131071.0}, 3);
  EXPECT_EQ(point.voxel, glm::ivec3(131070, 0, 131071));
  EXPECT_EQ(point.fraction, glm::vec3(0x1p-20f, 0.25f, 0.0f));
  EXPECT_EQ(point.level, 3);
}

TEST(PathTracing, ValuesOutsideTheirCellAreClampedAndCounted)
{
  inr::MacroCells cells = inr::MakeMacroCells({17, 17, 17}, 16);
  for (inr::ValueRange& range : cells.ranges) {
    range = {0.0f, 0.5f};
  }
  PathTest test(
      {17, 17, 17}, [](const glm::vec3&) { return 1.0f; }, OpacityRamp(0.2f), cells);
  EXPECT_LT(std::abs(test.estimate(3, 40).z(1.0 - std::pow(0.9, 16.0))), Unlikely);
  EXPECT_GT(test.statistics.samples, 0);
  EXPECT_EQ(test.statistics.clamped, test.statistics.samples);
}

TEST(PathTracing, RussianRouletteIsWithoutBias)
{
  Estimate estimates[2];
  for (const int roulette : {0, 1}) {
    PathTest test({17, 17, 17}, Cloud, OpacityRamp(0.6f));
    test.options.scatteringAlbedo = 0.7f;
    test.options.maximumBounces = 200;
    test.options.rouletteAfter = roulette == 1 ? 0 : 200;
    test.options.ambientLight = glm::vec3(0.5f);
    test.lights = {inr::Light{}};
    estimates[roulette] = test.estimate(0, 60);
  }
  const double error = std::hypot(estimates[0].error, estimates[1].error);
  EXPECT_LT(std::abs(estimates[0].mean - estimates[1].mean), Unlikely * error);
  EXPECT_LT(error, 0.01 * estimates[0].mean); // so that a bias would show
}

TEST(PathTracing, BouncesAreCounted)
{
  PathTest test({17, 17, 17}, Constant, UniformMedium(0.9f));
  test.options.ambientLight = glm::vec3(1.0f);
  test.lights = {inr::Light{}};
  test.options.maximumBounces = 0;
  EXPECT_EQ(test.estimate(0, 1).mean, 0.0);
  test.options.maximumBounces = 1;
  const double once = test.estimate(0, 20).mean;
  test.options.maximumBounces = 10;
  EXPECT_GT(test.estimate(0, 20).mean, 1.2 * once);
}

TEST(PathTracing, AccumulatorHoldsTheMeanOfCompletePictures)
{
  inr::Accumulator accumulator;
  accumulator.reset(2, 1);
  inr::Image mean;
  accumulator.mean(mean);
  EXPECT_EQ(mean.pixels, std::vector<float>(8, 0.0f));
  inr::Image sample(2, 1, 4);
  for (int k = 1; k <= 3; ++k) {
    std::fill(sample.pixels.begin(), sample.pixels.end(), static_cast<float>(k));
    accumulator.add(sample);
  }
  accumulator.mean(mean);
  EXPECT_EQ(accumulator.samples(), 3);
  EXPECT_EQ(mean.pixels, std::vector<float>(8, 2.0f));
  EXPECT_THROW(accumulator.add(inr::Image(1, 2, 4)), inr::Error);
  accumulator.reset(1, 1);
  EXPECT_EQ(accumulator.samples(), 0);
}

TEST(PathTracing, RefusesWhatIsOutOfRange)
{
  const auto refuses = [](const std::function<void(PathTest&)>& spoil) {
    PathTest test({3, 3, 3}, Constant, UniformMedium(0.1f));
    test.lights = {inr::Light{}};
    test.frame.mode = inr::RenderMode::PathTracing;
    const auto check = [&] {
      test.frame.paths = test.options;
      test.frame.lights = test.lights;
      inr::RequireValid(test.frame);
    };
    EXPECT_NO_THROW(check());
    spoil(test);
    EXPECT_THROW(check(), inr::Error);
  };
  refuses([](PathTest& test) { test.options.anisotropy = 1.0; });
  refuses([](PathTest& test) { test.options.anisotropy = NAN; });
  refuses([](PathTest& test) { test.options.scatteringAlbedo = 1.5f; });
  refuses([](PathTest& test) { test.options.maximumBounces = -1; });
  refuses([](PathTest& test) { test.options.rouletteAfter = -1; });
  refuses([](PathTest& test) { test.options.ambientLight.y = -1.0f; });
  refuses([](PathTest& test) { test.lights[0].direction = glm::dvec3(0.0); });
  refuses([](PathTest& test) { test.lights[0].color.x = INFINITY; });
  refuses([](PathTest& test) {
    test.lights[0].kind = inr::LightKind::Point;
    test.lights[0].attenuation = glm::dvec3(0.0);
  });
  refuses([](PathTest& test) {
    test.lights[0].kind = inr::LightKind::Spot;
    test.lights[0].coneAngle = 0;
  });
}

} // namespace test::path_tracing
