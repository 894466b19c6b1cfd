// SPDX-License-Identifier: BSD-3-Clause
//
// Pictures with Frame::errorTolerance against those with every sample from the full resolution.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/LevelChooser.h"
#include "Testing/Core/Image/PixelDifferences.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace {

const glm::i64vec3 Dims(112, 96, 104);

/// Smooth nearly everywhere, with wires a voxel or two thick.
float FogAndWires(const glm::vec3& u)
{
  const float fog = 0.3f + 0.2f * std::sin(5 * u.x + 2 * u.z) * std::cos(4 * u.y);
  float wire = 0;
  for (const glm::vec2 at : {glm::vec2(0.3f, 0.4f), glm::vec2(0.7f, 0.6f)}) {
    const float x = 100 * (u.x - at.x - 0.05f * std::sin(6 * u.z));
    const float y = 100 * (u.y - at.y);
    wire = std::max(wire, std::exp(-0.7f * (x * x + y * y)));
  }
  return fog * (1 - wire) + wire;
}

inr::MacroCells CellsOf(const FieldEvaluator::Function& field, const glm::i64vec3& dims)
{
  inr::MacroCells cells = inr::MakeMacroCells(dims, 16);
  for (std::int64_t k = 0; k < static_cast<std::int64_t>(cells.ranges.size()); ++k) {
    const glm::i64vec3 cell(k % cells.dims.x, k / cells.dims.x % cells.dims.y,
                            k / (cells.dims.x * cells.dims.y));
    for (int voxel = 0; voxel < 18 * 18 * 18; ++voxel) {
      const glm::i64vec3 within(voxel % 18 - 1, voxel / 18 % 18 - 1, voxel / 324 - 1);
      const glm::i64vec3 at =
          glm::clamp(cell * std::int64_t{16} + within, glm::i64vec3(0), dims - std::int64_t{1});
      cells.ranges[static_cast<std::size_t>(k)].extend(
          field(glm::vec3((glm::dvec3(at) + 0.5) / glm::dvec3(dims))));
    }
  }
  cells.apron = 1.0 / glm::dvec3(dims);
  return cells;
}

inr::TransferFunction Glow()
{
  inr::TransferFunction function;
  function.table = {{0.1f, 0.2f, 1, 0.005f}, {0.2f, 0.6f, 0.8f, 0.02f}, {1, 0.3f, 0, 0.3f}};
  return function;
}

inr::Renderer MakeRenderer(std::int64_t cacheBytes = 64 << 20, int threads = 2)
{
  inr::RendererOptions options;
  options.threads = threads;
  options.cache.bytes = cacheBytes;
  options.cache.precision = inr::CachePrecision::Float32;
  options.cache.brickSize = 16;
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(FogAndWires), VolumeOf(Dims),
                         CellsOf(FogAndWires, Dims), options);
  renderer.setTransferFunction(Glow());
  return renderer;
}

inr::Frame FrameWith(std::optional<double> tolerance)
{
  inr::Frame frame = Oblique(glm::dvec3(Dims), 72);
  frame.sampleDistance = 0.5;
  frame.unitDistance = 2;
  frame.errorTolerance = tolerance;
  return frame;
}

struct Drawn
{
  inr::Image picture;
  inr::FrameStatistics statistics;
};

Drawn Draw(inr::Renderer& renderer, const inr::Frame& frame)
{
  Drawn drawn;
  drawn.statistics = renderer.render(frame, drawn.picture);
  EXPECT_TRUE(drawn.statistics.complete);
  return drawn;
}

TEST(ErrorTolerance, OfZeroIsTheFullResolution)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame plain = FrameWith({});
  plain.levelOfDetailScale = 0;
  plain.adaptiveSampling = false;
  inr::Frame exact = FrameWith(0.0);
  exact.levelOfDetailScale = 3; // does not matter
  const Drawn drawn = Draw(renderer, exact);
  EXPECT_EQ(drawn.picture.pixels, Render(renderer, plain).pixels);
  EXPECT_EQ(drawn.statistics.levels.coarsest, 0);
}

TEST(ErrorTolerance, IsKeptWithFewerSamples)
{
  inr::Renderer renderer = MakeRenderer();
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  double last = static_cast<double>(exact.statistics.samples);
  for (const double tolerance : {0.5, 2.0, 8.0}) {
    const Drawn drawn = Draw(renderer, FrameWith(tolerance));
    EXPECT_GE(ShareWithin(tolerance, PixelDifferences(drawn.picture, exact.picture)), 0.999)
        << tolerance;
    EXPECT_LE(static_cast<double>(drawn.statistics.samples), last);
    last = static_cast<double>(drawn.statistics.samples);
  }
  EXPECT_LT(last, 0.4 * static_cast<double>(exact.statistics.samples));
}

TEST(ErrorTolerance, IsKeptAtAnySampleDistance)
{
  inr::Renderer renderer = MakeRenderer();
  for (const double distance : {0.3, 1.0, 2.0, 5.0}) {
    inr::Frame frame = FrameWith(0.0);
    frame.sampleDistance = distance;
    const Drawn exact = Draw(renderer, frame);
    frame.errorTolerance = 4.0;
    const Drawn drawn = Draw(renderer, frame);
    EXPECT_GE(ShareWithin(4.0, PixelDifferences(drawn.picture, exact.picture)), 0.999) << distance;
    EXPECT_LE(drawn.statistics.samples, exact.statistics.samples) << distance;
  }
}

/// Where rays that look ahead are several pixels apart.
TEST(ErrorTolerance, IsKeptBetweenTheRaysThatLookAhead)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith(0.0);
  frame.width = frame.height = 200;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 2.0;
  const Drawn drawn = Draw(renderer, frame);
  EXPECT_GE(ShareWithin(2.0, PixelDifferences(drawn.picture, exact.picture)), 0.999);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples);
}

TEST(ErrorTolerance, KeepsThinThingsThatDistanceAloneLoses)
{
  inr::Renderer renderer = MakeRenderer();
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  const Drawn tolerant = Draw(renderer, FrameWith(8.0));
  inr::Frame far = FrameWith({});
  far.adaptiveSampling = false;
  far.levelOfDetailScale = 1;
  Drawn distant = Draw(renderer, far);
  while (distant.statistics.samples > tolerant.statistics.samples) {
    far.levelOfDetailScale *= 1.1;
    distant = Draw(renderer, far);
  }
  EXPECT_GE(inr::ImagePsnr(tolerant.picture, exact.picture),
            inr::ImagePsnr(distant.picture, exact.picture) + 10);
}

TEST(ErrorTolerance, AsksForNextToNothingWhereColoursAreTheSame)
{
  inr::Renderer renderer = MakeRenderer();
  renderer.setTransferFunction(UniformMedium(0.01f));
  const Drawn exact = Draw(renderer, FrameWith(0.0));
  const Drawn drawn = Draw(renderer, FrameWith(0.01));
  EXPECT_LT(255 * inr::ImageMaximumError(drawn.picture, exact.picture), 0.01);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples / 6);
  EXPECT_EQ(drawn.statistics.levels.finest, inr::LevelErrors::Coarsest);
}

/// Macro-cells of 300 voxels would have to be known at once.
TEST(ErrorTolerance, TakesEverySampleOfWhatIsTooMuchToMeasure)
{
  const glm::i64vec3 dims(600, 600, 600);
  inr::MacroCells cells = inr::MakeMacroCells(dims, 300);
  std::fill(cells.ranges.begin(), cells.ranges.end(), inr::ValueRange{0, 1});
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(FogAndWires), VolumeOf(dims), cells,
                         options);
  renderer.setTransferFunction(Glow());
  inr::Frame frame = Oblique(glm::dvec3(dims), 4);
  frame.width = frame.height = 4;
  frame.unitDistance = 20;
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 20;
  const Drawn drawn = Draw(renderer, frame);
  EXPECT_EQ(drawn.picture.pixels, exact.picture.pixels);
  EXPECT_EQ(drawn.statistics.samples, exact.statistics.samples);
  EXPECT_EQ(drawn.statistics.work.networkSamples, 0); // for nothing but bricks
}

/// With next to no tolerance, in a medium of one colour: a part of the exact samples, at most.
Drawn ExpectFewSamples(const FieldEvaluator::Function& field, const glm::i64vec3& dims,
                       float opacity, std::int64_t part)
{
  inr::RendererOptions options;
  options.cache = Options(inr::CachePrecision::Float32, 16);
  inr::Renderer renderer(std::make_shared<FieldEvaluator>(field), VolumeOf(dims),
                         CellsOf(field, dims), options);
  renderer.setTransferFunction(UniformMedium(opacity));
  inr::Frame frame = Oblique(glm::dvec3(dims), 40);
  frame.errorTolerance = 0;
  const Drawn exact = Draw(renderer, frame);
  frame.errorTolerance = 0.01;
  Drawn drawn = Draw(renderer, frame);
  EXPECT_LT(255 * inr::ImageMaximumError(drawn.picture, exact.picture), 0.01);
  EXPECT_LT(drawn.statistics.samples, exact.statistics.samples / part);
  return drawn;
}

/// And shows nothing beyond it, where values reach but do not pass the end.
TEST(ErrorTolerance, AsksForNoMoreWhereATableEndsWithTheData)
{
  const auto field = [](const glm::vec3& u) {
    return glm::clamp(0.5f + 2 * std::cos(40 * u.x), 0.0f, 1.0f);
  };
  ExpectFewSamples(field, glm::i64vec3(96), 0.01f, 6);
}

/// Which has no coarser level, but samples further apart.
TEST(ErrorTolerance, IsKeptInASingleBrick)
{
  const Drawn drawn = ExpectFewSamples(FogAndWires, {15, 14, 15}, 0.3f, 3);
  EXPECT_EQ(drawn.statistics.levels.coarsest, 0);
}

TEST(ErrorTolerance, DrawsTheSameWhateverTheCacheHolds)
{
  inr::Renderer roomy = MakeRenderer(64 << 20, 2);
  inr::Renderer narrow = MakeRenderer(400 << 10, 1);
  const inr::Frame frame = FrameWith(2.0);
  EXPECT_EQ(Draw(roomy, frame).picture.pixels, Draw(narrow, frame).picture.pixels);
  roomy.setTransferFunction(UniformMedium(0.2f)); // and whatever was drawn before
  Draw(roomy, FrameWith(20.0));
  roomy.setTransferFunction(Glow());
  EXPECT_EQ(Draw(roomy, frame).picture.pixels, Draw(narrow, frame).picture.pixels);
}

TEST(ErrorTolerance, IsNotForWhatIsLitCroppedOrProjected)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith({});
  const auto expectExact = [&](const inr::Frame& wanted) {
    inr::Frame exact = wanted;
    exact.errorTolerance = 0;
    inr::Frame tolerant = wanted;
    tolerant.errorTolerance = 30;
    EXPECT_EQ(Draw(renderer, tolerant).picture.pixels, Draw(renderer, exact).picture.pixels);
  };
  frame.shading = inr::Material{};
  frame.lights = {inr::Light{}};
  expectExact(frame);
  frame.shading.reset();
  frame.blending.mode = inr::BlendMode::MaximumIntensity;
  expectExact(frame);
  frame.blending = {};
  frame.cropping = inr::Cropping{{30, 30, 30}, {80, 70, 80}, 1 << 13 | 1 << 0}; // and a corner
  expectExact(frame);
}

/// However short a frame's time is, the next one is further.
TEST(ErrorTolerance, ComesAboutInLimitedTime)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith({});
  frame.adaptiveSampling = false;
  frame.levelOfDetailScale = 1;
  frame.width = frame.height = 24;
  EXPECT_GT(Draw(renderer, frame).statistics.levels.finest, 0); // shown meanwhile: it is there
  frame.errorTolerance = 4.0;
  frame.timeLimit = 1e-3;
  inr::Image picture;
  inr::FrameStatistics statistics = renderer.render(frame, picture);
  EXPECT_FALSE(statistics.complete);
  EXPECT_EQ(statistics.missed, 0);
  int frames = 1;
  for (; !statistics.complete; ++frames) {
    ASSERT_LT(frames, 2000);
    statistics = renderer.render(frame, picture);
  }
  EXPECT_GT(frames, 2); // eight blocks on two threads
  inr::Renderer unhurried = MakeRenderer();
  frame.timeLimit = 0;
  EXPECT_LE(inr::ImageMaximumError(picture, Draw(unhurried, frame).picture), 2e-3f);
}

TEST(ErrorTolerance, MeasuresTheFieldOnceForAllTolerancesAndColours)
{
  inr::Renderer renderer = MakeRenderer();
  EXPECT_EQ(Draw(renderer, FrameWith(0.0)).statistics.work.networkSamples, 0);
  const Drawn first = Draw(renderer, FrameWith(4.0));
  const auto measured = first.statistics.work.networkSamples;
  EXPECT_GE(measured, Dims.x * Dims.y * Dims.z);
  EXPECT_LT(measured, 2.3 * static_cast<double>(Dims.x * Dims.y * Dims.z)); // blocks overlap
  EXPECT_EQ(Draw(renderer, FrameWith(2.0)).statistics.work.networkSamples, 0);
  renderer.setTransferFunction(UniformMedium(0.2f));
  EXPECT_EQ(Draw(renderer, FrameWith(2.0)).statistics.work.networkSamples, 0);
}

/// What is hard about a scene.
struct HardScene
{
  const char* name;
  FieldEvaluator::Function field;
  inr::TransferFunction colours;
  glm::dvec3 along;   ///< way of parallel rays
  double spacing = 1; ///< of z, in those of x and y
  double unitDistance = 8;
};

inr::TransferFunction Ramp(const glm::vec4& from, const glm::vec4& to)
{
  inr::TransferFunction function;
  for (int k = 0; k < 256; ++k) {
    function.table.push_back(glm::mix(from, to, static_cast<float>(k) / 255));
  }
  return function;
}

/// One every three voxels of a gradient over 96.
inr::TransferFunction Peaks()
{
  inr::TransferFunction function;
  for (int k = 0; k < 1024; ++k) {
    const float place = 32.0f * static_cast<float>(k) / 1023;
    const float peak = std::max(0.0f, 1 - 4 * std::abs(place - std::floor(place) - 0.5f));
    function.table.emplace_back(1, 1, 1, 0.3f * peak);
  }
  return function;
}

FieldEvaluator::Function Waves(const glm::vec3& perVoxel)
{
  return [perVoxel](const glm::vec3& u) {
    return 0.5f + 0.45f * std::cos(6.2831853f * glm::dot(perVoxel, 96.0f * u));
  };
}

/// About two voxels thick, 24 apart.
FieldEvaluator::Function Sheets(const glm::vec3& normal)
{
  return [across = glm::normalize(normal)](const glm::vec3& u) {
    const float place = glm::dot(across, 96.0f * u) / 24;
    const float distance = 24 * (place - std::round(place));
    return 0.1f + 0.8f * std::exp(-distance * distance);
  };
}

float Noise(const glm::vec3& u)
{
  const glm::i64vec3 voxel(96.0f * u);
  return static_cast<float>(
      inr::RandomUnit(21, static_cast<std::uint64_t>(voxel.x + 100 * (voxel.y + 100 * voxel.z))));
}

/// What a function of the voxel gives, and linear in between.
FieldEvaluator::Function Linear(const std::function<float(const glm::i64vec3&)>& valueOf)
{
  const auto voxels = std::make_shared<const Voxels>(
      glm::i64vec3(96), [&](const glm::vec3& u) { return valueOf(glm::i64vec3(96.0f * u)); });
  return [voxels](const glm::vec3& u) { return voxels->at(u); };
}

float Layer(const glm::i64vec3& at) { return at.z % 24 == 8 ? 0.9f : 0.1f; }

float Checkerboard(const glm::i64vec3& at)
{
  return (at.x / 16 + at.y / 16 + at.z / 16) % 2 == 0 ? 0.9f : 0.1f;
}

float Gyroid(const glm::i64vec3& at)
{
  const glm::vec3 a = 1.5707963f * (glm::vec3(at) + 0.5f); // four voxels to a turn
  return 0.5f + 0.25f * (std::sin(a.x) * std::cos(a.y) + std::sin(a.y) * std::cos(a.z) +
                         std::sin(a.z) * std::cos(a.x));
}

std::ostream& operator<<(std::ostream& out, const HardScene& scene) { return out << scene.name; }

std::vector<HardScene> HardScenes()
{
  const inr::TransferFunction faint = Ramp({1, 0.5f, 0, 0}, {1, 0.5f, 0, 0.05f});
  const inr::TransferFunction opaque = Ramp({1, 0.2f, 0, 1}, {0, 0.5f, 1, 0});
  const inr::TransferFunction bright = Ramp({20, 0, 1, 0.01f}, {0, 0, 1, 0.1f});
  inr::TransferFunction middle = Ramp({1, 0.7f, 0, 0.05f}, {1, 0.7f, 0, 0.05f});
  middle.low = 0.4;
  middle.high = 0.6;
  inr::TransferFunction upper = middle;
  upper.high = 1;
  inr::TransferFunction lamp = Ramp({0, 0, 0, 0}, {0, 0, 0, 0.1f});
  std::fill(lamp.table.begin() + 200, lamp.table.end(), glm::vec4(20, 20, 20, 0.5f));
  const auto smokeBeforeLamp = [](const glm::vec3& u) {
    return u.z > 0.5f ? 0.9f : 0.4f + 0.3f * std::cos(40 * u.x);
  };
  const glm::dvec3 z(0, 0, 1);
  return {{"LayersAlongRays", Waves({1.0f / 24, 0, 0}), faint, z},
          {"ShortLayersAlongRays", Waves({1.0f / 16, 0, 0}), faint, z},
          {"LayersAlongLongVoxels", Waves({1.0f / 16, 0, 0}), faint, z, 8, 64},
          {"ObliqueLayers", Waves(glm::vec3(1, 1, -2) / 40.0f), faint, {1, 1, 1}},
          {"LayersAtOddAngles", Waves(glm::vec3(3, -5, 0) / 90.0f), faint, {5, 3, 1}},
          {"SheetsAtOddAngles", Sheets({1, 2, -7}), faint, {3, 2, 1}},
          {"SheetsAcross", Sheets({2, 1, 5}), faint, {2, 1, 5}},
          {"SlopingSlices", Waves({1.0f / 60, 0, 1.0f / 24}), faint, {0.05, 0, 1}, 8},
          {"Noise", Noise, faint, {1, 2, 5}},
          {"LayersOfAVoxel", Linear(Layer), faint, z},
          {"Checkerboard", Linear(Checkerboard), faint, {1, 0.3, 0.2}},
          {"Gyroid", Linear(Gyroid), faint, z},
          {"OpacityOfOne", Waves({1.0f / 30, 0, 1.0f / 50}), opaque, z, 1, 1},
          {"FarApartSlices", Waves({1.0f / 60, 0, 1.0f / 40}), faint, {1, 0.1, 0}, 30, 8},
          {"EdgeBelow", Waves({1.0f / 40, 0, 1.0f / 50}), upper, {0.3, 0.2, 1}},
          {"EdgesOfTheMiddle", Waves({1.0f / 40, 0, 1.0f / 50}), middle, {0.3, 0.2, 1}},
          {"SmokeBeforeALamp", smokeBeforeLamp, lamp, z},
          {"BrightColours", Waves({1.0f / 40, 1.0f / 50, 0}), bright, {0.3, 0.2, 1}},
          {"PeaksInAGradient", [](const glm::vec3& u) { return u.z; }, Peaks(), z},
          {"OneOpacity",
           Waves({0, 1.0f / 8, 0}),
           Ramp({0, 1, 0, 0.05f}, {1, 0, 1, 0.05f}),
           {0.1, 1, 0.05},
           1,
           2}};
}

/// A hard scene, and a picture of all of it.
class HardPicture
{
public:
  explicit HardPicture(const HardScene& scene)
      : Renderer(std::make_shared<FieldEvaluator>(scene.field), VolumeOf(Dims),
                 CellsOf(scene.field, Dims), TwoThreads())
  {
    this->Renderer.setTransferFunction(scene.colours);
    const glm::dvec3 stretch(1, 1, scene.spacing);
    const glm::dvec3 middle = 47.5 * stretch;
    const double reach = glm::length(middle);
    const glm::dvec3 up = std::abs(scene.along.z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    this->Frame.width = this->Frame.height = 64;
    this->Frame.unitDistance = scene.unitDistance;
    this->Frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / stretch);
    this->Frame.clipToWorld =
        glm::inverse(glm::ortho(-reach, reach, -reach, reach, -2 * reach, 2 * reach) *
                     glm::lookAt(middle, middle + scene.along, up));
  }

  Drawn drawWith(double tolerance, double sampleDistance)
  {
    this->Frame.sampleDistance = sampleDistance;
    this->Frame.errorTolerance = tolerance;
    return Draw(this->Renderer, this->Frame);
  }

private:
  static inr::RendererOptions TwoThreads()
  {
    inr::RendererOptions options;
    options.threads = 2;
    options.cache = Options(inr::CachePrecision::Float32, 16);
    return options;
  }

  static constexpr glm::i64vec3 Dims{96, 96, 96};
  inr::Renderer Renderer;
  inr::Frame Frame;
};

class HardToKeepTo : public testing::TestWithParam<HardScene>
{};

TEST_P(HardToKeepTo, ATolerance)
{
  HardPicture picture(this->GetParam());
  for (const double distance : {0.5, 4.0}) {
    const Drawn exact = picture.drawWith(0, distance);
    EXPECT_GT(exact.statistics.samples, 1000);
    for (const double tolerance : {0.5, 2.0, 8.0, 32.0, 52.0}) {
      const Drawn drawn = picture.drawWith(tolerance, distance);
      EXPECT_GE(ShareWithin(tolerance, PixelDifferences(drawn.picture, exact.picture)), 0.999)
          << tolerance << " " << distance;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, HardToKeepTo, testing::ValuesIn(HardScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ErrorTolerance, MustNotBeNegative)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Image picture;
  for (const double tolerance : {-1.0, std::nan("")}) {
    EXPECT_THROW(renderer.render(FrameWith(tolerance), picture), inr::Error);
  }
}

TEST(ErrorTolerance, HasPiecesThatMakeUpTheWhole)
{
  inr::Renderer renderer = MakeRenderer();
  inr::Frame frame = FrameWith(4.0);
  const inr::Image whole = Draw(renderer, frame).picture;
  const glm::dvec4 cut(1, 0.2, 0.3, -81.4);
  frame.piece = {cut}; // the viewer is on this side
  const inr::Image near = Draw(renderer, frame).picture;
  frame.piece = {-cut};
  inr::Image blended = near;
  const inr::Image behind = Draw(renderer, frame).picture;
  for (std::size_t k = 0; k < blended.pixels.size(); ++k) {
    blended.pixels[k] += (1 - near.pixels[k / 4 * 4 + 3]) * behind.pixels[k];
  }
  // Rays end where they are opaque enough, at another place when what is in front is not known.
  EXPECT_LT(inr::ImageMaximumError(blended, whole), 2e-3f);
  EXPECT_GT(inr::ImageMaximumError(near, whole), 0.02f);
}

} // namespace
