// SPDX-License-Identifier: BSD-3-Clause
//
// Colours of all values between two samples: the integrals against sums in double, pictures against
// media whose transmittance is known, finer sampling, and one another.
#include "Core/Image/Metrics.h"
#include "Core/Render/Marching/PreIntegratedColors.h"
#include "Testing/Core/Render/HiddenScene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace test::pre_integration {

inr::VolumeInfo VolumeBetween(double low, double high)
{
  inr::VolumeInfo volume = VolumeOf({8, 8, 8});
  volume.low = low;
  volume.high = high;
  return volume;
}

/// Extinction times RGB, and extinction, of the middle values of many pieces.
glm::dvec4 MeanDensity(const inr::ColorLookup& colors, double first, double last)
{
  constexpr int pieces = 40000;
  glm::dvec4 sum(0.0);
  for (int k = 0; k < pieces; ++k) {
    const double value = first + (last - first) * (k + 0.5) / pieces;
    const glm::vec4 entry = colors.at(static_cast<float>(value));
    const double extinction = entry.w < 1 ? -std::log1p(-static_cast<double>(entry.w)) : 0x1p16;
    sum += glm::dvec4(glm::dvec3(entry) * extinction, extinction);
  }
  return sum / static_cast<double>(pieces);
}

void ExpectMean(const inr::PreIntegratedLookup& lookup, const inr::ColorLookup& colors, float first,
                float last)
{
  const glm::dvec4 truth = MeanDensity(colors, first, last);
  const glm::dvec4 found = lookup.between(first, last);
  if (truth.w > 10) { // more than an opacity in float can tell
    EXPECT_GT(found.w, 0.9999) << first << " " << last;
    return;
  }
  const double extinction = -std::log1p(-found.w);
  EXPECT_NEAR(extinction, truth.w, 2e-3 * truth.w + 1e-6) << first << " " << last;
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(found[channel] * extinction, truth[channel], 2e-3 * truth.w + 1e-6)
        << first << " " << last << " " << channel;
  }
  EXPECT_EQ(lookup.between(last, first), lookup.between(first, last));
}

/// A peak that is 1/100 of the range wide, over something faint, and opaque from 0.9 on.
inr::TransferFunction Peaks()
{
  inr::TransferFunction function;
  for (int k = 0; k <= 1000; ++k) {
    const float x = static_cast<float>(k) / 1000;
    const float peak = std::max(0.0f, 0.8f - 160 * std::abs(x - 0.4f));
    function.table.emplace_back(x, 1 - x, 0.25f, x >= 0.9f ? 1.0f : std::max(peak, 1e-3f));
  }
  return function;
}

TEST(PreIntegration, IsTheMeanOfAllValuesBetween)
{
  inr::TransferFunction few;
  few.table = {{1, 0, 0, 0}, {0, 1, 0, 0.3f}, {0, 0, 1, 0.95f}, {0, 0, 0, 0.1f}};
  inr::TransferFunction narrow = few; // with a step at either end
  narrow.low = 0.25;
  narrow.high = 0.7;
  narrow.below = {1, 1, 0, 0.2f};
  narrow.above = {0, 1, 1, 0};
  for (const auto& function : {few, narrow, Peaks()}) {
    const inr::ColorTable colors(function, VolumeBetween(0, 1));
    const inr::PreIntegratedColors integrals(colors.lookup());
    for (const auto& [first, last] : std::vector<std::pair<float, float>>{
             {0.1f, 0.8f}, {0.0f, 1.0f}, {0.39f, 0.41f}, {0.2f, 0.26f}, {0.3f, 0.3005f}}) {
      ExpectMean(integrals.lookup(), colors.lookup(), first, last);
    }
  }
}

TEST(PreIntegration, OfALogarithmIsTheMeanOverThat)
{
  inr::TransferFunction function;
  function.table = {{1, 0, 0, 0.1f}, {0, 1, 0, 0.8f}};
  function.logarithmic = true;
  function.low = 1;
  function.high = 1e4;
  const inr::ColorTable colors(function, VolumeBetween(0, 1e4));
  const inr::PreIntegratedColors integrals(colors.lookup());
  // Half of the way between the logarithms of 10 and 1,000 is 100, where opacity is 0.45.
  const glm::vec4 mean = integrals.lookup().between(1e-3f, 1e-1f);
  double extinction = 0;
  for (int k = 0; k < 1000; ++k) {
    extinction -= std::log1p(-(0.1 + 0.7 * (0.25 + 0.5 * (k + 0.5) / 1000))) / 1000;
  }
  EXPECT_NEAR(-std::log1p(-mean.w), extinction, 1e-3 * extinction);
}

TEST(PreIntegration, OfOneValueIsItsColour)
{
  const inr::ColorTable colors(Peaks(), VolumeBetween(0, 1));
  const inr::PreIntegratedColors integrals(colors.lookup());
  for (float y = 0; y < 0.9f; y += 1.0f / 777) {
    const glm::vec4 entry = colors.lookup().at(y);
    const glm::vec4 found = integrals.lookup().between(y, y);
    for (int channel = 0; channel < 4; ++channel) {
      EXPECT_NEAR(found[channel], entry[channel], 1e-3f) << y << " " << channel;
    }
    const glm::vec4 near = integrals.lookup().between(y, y + 3e-6f); // no jump where sums begin
    EXPECT_NEAR(near.w, found.w, 2e-3f) << y;
  }
  EXPECT_NEAR(integrals.lookup().between(0.95f, 0.95f).w, 1.0f, 1e-6f);
}

inr::Frame AlongZ(double distance)
{
  inr::Frame frame = ParallelFrame(6, {4, 4}, {20, 20}, -30, 80);
  frame.levelOfDetailScale = 0;
  frame.sampleDistance = distance;
  frame.preIntegration = true;
  return frame;
}

// A field that rises from 0 to 1 along the rays meets each value for as long as any other,
// however few samples there are.
TEST(PreIntegration, MissesNoPeakOfALinearMedium)
{
  const glm::i64vec3 dims(24, 24, 33);
  const inr::ColorTable colors(Peaks(), VolumeBetween(0, 1));
  inr::TransferFunction peaks = Peaks();
  for (glm::vec4& entry : peaks.table) { // no more than half a peak's light is held back
    entry.w = entry.w < 1 ? 0.5f * entry.w : 0.0f;
  }
  const inr::ColorTable half(peaks, VolumeBetween(0, 1));
  const double extinction = MeanDensity(half.lookup(), 0.5 / 33, 32.5 / 33).w;
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(
        dims, [](const glm::vec3& u) { return u.z; }, {}, 2, cached);
    renderer.setTransferFunction(peaks);
    for (const double distance : {0.1, 0.7, 1.0, 3.3}) {
      for (const double unit : {1.0, 2.5}) {
        inr::Frame frame = AlongZ(distance);
        frame.unitDistance = unit;
        const double opacity = -std::expm1(-extinction * 32 / unit);
        for (const float alpha :
             {Render(renderer, frame).pixel(2, 2)[3], Render(renderer, frame).pixel(5, 0)[3]}) {
          EXPECT_NEAR(alpha, opacity, 2e-3 * opacity) << distance << " " << unit << " " << cached;
        }
      }
    }
  }
}

TEST(PreIntegration, IsExactInAHomogeneousMedium)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(
        {24, 24, 33}, [](const glm::vec3&) { return 0.5f; }, {}, 2, cached);
    renderer.setTransferFunction(UniformMedium(0.03f, {0.2f, 0.4f, 0.8f}));
    for (const double distance : {0.3, 1.0, 7.0, 100.0}) {
      const inr::Image picture = Render(renderer, AlongZ(distance));
      const double opacity = 1 - std::pow(0.97, 32);
      EXPECT_NEAR(picture.pixel(1, 1)[3], opacity, 1e-5) << distance;
      EXPECT_NEAR(picture.pixel(1, 1)[2], 0.8 * opacity, 1e-5) << distance;
    }
  }
}

constexpr glm::i64vec3 Dims(60, 45, 52);

inr::Frame Near(double distance)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims));
  frame.sampleDistance = distance;
  frame.adaptiveSampling = false;
  return frame;
}

double PsnrOf(inr::Renderer& renderer, const inr::Frame& frame, const inr::Image& truth)
{
  return inr::ImagePsnr(Render(renderer, frame), truth);
}

// What it is for: of thin shells, as much as many times as many samples show.
TEST(PreIntegration, ShowsThinShellsWithFewSamples)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(Dims, Waves, {}, 2, cached);
    renderer.setTransferFunction(Shell(0));
    const inr::Image truth = Render(renderer, Near(1. / 40));
    inr::Frame frame = Near(1);
    const double plain = PsnrOf(renderer, frame, truth);
    frame.preIntegration = true;
    EXPECT_GT(PsnrOf(renderer, frame, truth), plain + 12) << cached;
    frame.sampleDistance = 2;
    EXPECT_GT(PsnrOf(renderer, frame, truth), plain + 6) << cached;
    frame.sampleDistance = 1. / 40; // and with many it is the same
    EXPECT_GT(PsnrOf(renderer, frame, truth), 55) << cached;
  }
}

struct Kind
{
  std::string name;
  std::function<void(inr::Frame&)> set;
};

const Kind Kinds[] = {
    {"as it is", [](inr::Frame&) {}},
    {"shaded",
     [](inr::Frame& frame) {
       frame.shading.emplace();
       frame.lights.emplace_back();
     }},
    {"joined",
     [](inr::Frame& frame) {
       frame.adaptiveSampling = true;
       frame.unitDistance = 60;
     }},
    {"far apart", [](inr::Frame& frame) { frame.sampleDistance = 3.7; }},
    {"cropped",
     [](inr::Frame& frame) {
       frame.cropping = {{20, 15, 20}, {40, 30, 35}, 0x2ebfeba};
     }},
    {"behind something opaque",
     [](inr::Frame& frame) {
       static const std::vector<float> depth(static_cast<std::size_t>(frame.width) * frame.height,
                                             0.905f);
       frame.opaqueDepth = depth.data();
     }},
    {"around something translucent", AddLayerHalfWay},
    {"a piece",
     [](inr::Frame& frame) {
       frame.piece = {{0.3, 0.2, 1, -35}, {-0.3, -0.2, -1, 55}};
     }},
};

// Asking for each sample by itself, through whatever is in between, gives the same picture as the
// cache of the same voxels, in whatever bricks.
TEST(PreIntegration, IsTheSameFromTheCacheAndFromDenseVoxels)
{
  const Voxels voxels(Dims, Waves);
  inr::Renderer dense = FieldRenderer(
      Dims, [&](const glm::vec3& u) { return voxels.at(u); }, {}, 2);
  dense.setTransferFunction(Shell(0));
  for (const Kind& kind : Kinds) {
    SCOPED_TRACE(kind.name);
    inr::Frame frame = Near(0.7);
    frame.preIntegration = true;
    kind.set(frame);
    const inr::Image truth = Render(dense, frame);
    for (const int brickSize : {9, 40}) {
      inr::Renderer cached =
          CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, brickSize));
      cached.setTransferFunction(Shell(0));
      EXPECT_GT(PsnrOf(cached, frame, truth), 85) << brickSize;
    }
    EXPECT_GT(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 0.02f);
  }
}

// Rays that wait for bricks, and bricks that have to go in between.
TEST(PreIntegration, DoesNotDependOnWhatFits)
{
  for (const Kind& kind : Kinds) {
    SCOPED_TRACE(kind.name);
    inr::Frame frame = Near(0.7);
    frame.preIntegration = true;
    frame.levelOfDetailScale = 1.7;
    kind.set(frame);
    inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 17);
    inr::Image pictures[2];
    for (const int small : {0, 1}) {
      options.bytes = small != 0 ? options.bytes / 300 : options.bytes;
      inr::Renderer renderer = CachedRenderer(Dims, Waves, options, small != 0 ? 1 : 2);
      renderer.setTransferFunction(Shell(0));
      EXPECT_TRUE(renderer.render(frame, pictures[small]).complete);
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
  }
}

struct LitScene
{
  double distance;
  float width; ///< of the shell
  int brickSize;
  std::int64_t bytes; ///< of the smaller cache
};

// Of lit samples, the first of a batch may wait for the bricks around it more than once: its light
// falls through what was between it and the one before all the same, whether it shows something
// itself, as those close together do, or not.
TEST(PreIntegration, KeepsWhatItKnewWhileLightWaitsForBricks)
{
  for (const LitScene& scene : {LitScene{0.2, 0.03f, 6, 24 << 10}, {3.7, 0.06f, 9, 60 << 10}}) {
    SCOPED_TRACE(scene.distance);
    inr::Frame frame = Near(scene.distance);
    frame.preIntegration = true;
    frame.levelOfDetailScale = 1;
    frame.shading.emplace();
    frame.lights.emplace_back();
    inr::CacheOptions options = Options(inr::CachePrecision::Float32, scene.brickSize);
    inr::Image pictures[2];
    for (const int small : {0, 1}) {
      options.bytes = small != 0 ? scene.bytes : options.bytes;
      inr::Renderer renderer = CachedRenderer(Dims, Waves, options, small != 0 ? 1 : 2);
      renderer.setTransferFunction(Shell(0, scene.width));
      EXPECT_TRUE(renderer.render(frame, pictures[small]).complete);
    }
    EXPECT_EQ(pictures[0].pixels, pictures[1].pixels);
  }
}

// What is looked at between samples is of their level, and for the most part in their bricks.
TEST(PreIntegration, AsksForHardlyMoreBricks)
{
  for (const double scale : {0.0, 2.0, 4.0}) {
    std::int64_t bricks[2];
    for (const bool integrates : {false, true}) {
      inr::Renderer renderer = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Bits16, 9));
      renderer.setTransferFunction(Shell(0));
      inr::Frame frame = Near(2);
      frame.levelOfDetailScale = scale;
      frame.preIntegration = integrates;
      Render(renderer, frame);
      bricks[integrates] = renderer.cachedBricks();
    }
    EXPECT_LE(bricks[1], bricks[0] + bricks[0] / 5) << scale;
  }
}

// Values before the first sample of a cell are asked for where no range bounds them.
TEST(PreIntegration, EndsWithANumberBesideWhatIsNone)
{
  const glm::i64vec3 dims(24, 24, 33);
  inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  const auto layer = static_cast<std::size_t>(cells.dims.x * cells.dims.y);
  for (std::size_t k = 0; k < cells.ranges.size(); ++k) { // the first layer shows nothing
    const float value = k < layer ? 0.1f : 0.7f;
    cells.ranges[k] = {value, value};
  }
  const auto field = [](const glm::vec3& u) {
    return u.z < 0.495f ? std::numeric_limits<float>::quiet_NaN() : 0.7f;
  };
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(dims, field, cells, 2, cached);
    renderer.setTransferFunction(Shell(0));
    for (const float number : Render(renderer, AlongZ(0.7)).pixels) {
      EXPECT_TRUE(std::isfinite(number)) << cached;
    }
  }
}

// The cache composites logarithms, and other colours after others.
TEST(PreIntegration, IsTheSameFromTheCacheForOtherColours)
{
  const Voxels voxels(Dims, Waves);
  inr::TransferFunction logarithmic = Shell(0);
  logarithmic.logarithmic = true;
  logarithmic.low = 0.05;
  inr::Renderer dense = FieldRenderer(
      Dims, [&](const glm::vec3& u) { return voxels.at(u); }, {}, 2);
  inr::Renderer cached = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 17));
  inr::Frame frame = Near(0.7);
  frame.preIntegration = true;
  for (const auto& function : {Shell(0), logarithmic, Shell(0, 0.05f)}) {
    dense.setTransferFunction(function);
    cached.setTransferFunction(function);
    const inr::Image truth = Render(dense, frame);
    EXPECT_GT(PsnrOf(cached, frame, truth), 85);
    inr::Renderer fresh = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 17));
    fresh.setTransferFunction(function);
    EXPECT_EQ(Render(fresh, frame).pixels, Render(cached, frame).pixels);
  }
}

// As without it, however long the unit is.
TEST(PreIntegration, LeavesOpaqueWhatIs)
{
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(
        {24, 24, 33}, [](const glm::vec3&) { return 0.5f; }, {}, 2, cached);
    renderer.setTransferFunction(UniformMedium(1.0f));
    inr::Frame frame = AlongZ(0.5);
    for (const double unit : {1.0, 100.0, 1000.0}) {
      frame.unitDistance = unit;
      EXPECT_GT(Render(renderer, frame).pixel(1, 1)[3], 0.999f) << unit;
    }
  }
}

/// Ranges of cells of 4 voxels, as the voxels around have them.
inr::MacroCells CellsOf(const Voxels& voxels)
{
  inr::MacroCells cells = inr::MakeMacroCells(Dims, 4);
  for (std::int64_t z = 0; z < cells.dims.z; ++z) {
    for (std::int64_t y = 0; y < cells.dims.y; ++y) {
      for (std::int64_t x = 0; x < cells.dims.x; ++x) {
        inr::ValueRange& range =
            cells.ranges[static_cast<std::size_t>(x + cells.dims.x * (y + cells.dims.y * z))];
        for (int k = 0; k < 9 * 9 * 9; ++k) { // from one side to the other
          const glm::dvec3 in(k % 9, k / 9 % 9, k / 81);
          range.extend(voxels.at(glm::vec3((glm::dvec3(x, y, z) + in / 8.0) * cells.spacing)));
        }
        range = {range.low - 0.01f, range.high + 0.01f};
      }
    }
  }
  return cells;
}

// Samples right before and behind cells that can be seen count, too.
TEST(PreIntegration, MissesNothingBesideCellsThatAreSkipped)
{
  const Voxels voxels(Dims, Waves);
  const auto field = [&](const glm::vec3& u) { return voxels.at(u); };
  for (const bool cached : {false, true}) {
    inr::Renderer all = FieldRenderer(Dims, field, {}, 2, cached);
    inr::Renderer some = FieldRenderer(Dims, field, CellsOf(voxels), 2, cached);
    for (inr::Renderer* renderer : {&all, &some}) {
      renderer->setTransferFunction(Shell(0));
    }
    for (const Kind& kind : Kinds) {
      SCOPED_TRACE(kind.name);
      inr::Frame frame = Near(0.7);
      frame.preIntegration = true;
      frame.unitDistance = 0.2;
      kind.set(frame);
      inr::Image pictures[2];
      const std::int64_t samples = all.render(frame, pictures[0]).samples;
      EXPECT_LT(some.render(frame, pictures[1]).samples, samples);
      const bool isCut = kind.name == "joined" || kind.name == "far apart"; // cells from corner on
      EXPECT_GT(inr::ImagePsnr(pictures[1], pictures[0]), isCut ? 55 : 85) << cached;
    }
  }
}

TEST(PreIntegration, GivesWayToAnErrorTolerance)
{
  inr::Renderer renderer = FieldRenderer(Dims, Waves, {}, 2, true);
  renderer.setTransferFunction(Shell(0));
  inr::Frame frame = Near(0.7);
  frame.errorTolerance = 2;
  const inr::Image plain = Render(renderer, frame);
  frame.preIntegration = true;
  EXPECT_EQ(Render(renderer, frame).pixels, plain.pixels);
}

TEST(PreIntegration, IsForWhatIsComposited)
{
  inr::Renderer renderer = FieldRenderer(Dims, Waves, {}, 2, true);
  renderer.setTransferFunction(Shell(0));
  inr::Frame frame = Near(0.7);
  for (const auto mode : {inr::BlendMode::MaximumIntensity, inr::BlendMode::Additive}) {
    frame.blending.mode = mode;
    frame.preIntegration = false;
    const inr::Image plain = Render(renderer, frame);
    frame.preIntegration = true;
    EXPECT_EQ(Render(renderer, frame).pixels, plain.pixels);
  }
  frame.blending.mode = inr::BlendMode::Composite;
  frame.mode = inr::RenderMode::PathTracing;
  frame.samplesPerPixel = 2;
  frame.lights = {inr::Light{}};
  frame.preIntegration = false;
  const inr::Image plain = Render(renderer, frame);
  frame.preIntegration = true;
  EXPECT_EQ(Render(renderer, frame).pixels, plain.pixels);
}

} // namespace test::pre_integration
