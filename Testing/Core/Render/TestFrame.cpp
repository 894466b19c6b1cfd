// SPDX-License-Identifier: BSD-3-Clause
//
// Every field of what makes a picture makes another picture, or is listed as one that does not. A
// field that is added does not compile here before it is thought of: it needs a name in FieldsOf
// and a line in a table.
#include "Core/Render/Renderer.h"
#include "Core/Render/Scene/DrawnFrame.h"
#include "Core/Render/Scene/FrameStatistics.h"
#include "Testing/Core/FakeAccelerator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace test::frame {

template <typename... Field> std::size_t Count(const Field&...) { return sizeof...(Field); }

std::size_t FieldsOf(const inr::Frame& frame)
{
  const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, last] =
      frame;
  return Count(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z, last);
}

std::size_t FieldsOf(const inr::Material& material)
{
  const auto& [a, b, c, d] = material;
  return Count(a, b, c, d);
}

std::size_t FieldsOf(const inr::Light& light)
{
  const auto& [a, b, c, d, e, f, g] = light;
  return Count(a, b, c, d, e, f, g);
}

std::size_t FieldsOf(const inr::Blending& blending)
{
  const auto& [a, b, c, d] = blending;
  return Count(a, b, c, d);
}

std::size_t FieldsOf(const inr::Cropping& cropping)
{
  const auto& [a, b, c] = cropping;
  return Count(a, b, c);
}

std::size_t FieldsOf(const inr::PathOptions& paths)
{
  const auto& [a, b, c, d, e, f] = paths;
  return Count(a, b, c, d, e, f);
}

std::size_t FieldsOf(const inr::TranslucentLayers::Layer& layer)
{
  const auto& [a, b] = layer;
  return Count(a, b);
}

std::size_t FieldsOf(const inr::RendererOptions& options)
{
  const auto& [a, b, c, d, e, f, g] = options;
  return Count(a, b, c, d, e, f, g);
}

std::size_t FieldsOf(const inr::CacheOptions& options)
{
  const auto& [a, b, c, d, e, f, g, h] = options;
  return Count(a, b, c, d, e, f, g, h);
}

template <typename Value> struct Change
{
  std::string field;
  std::function<void(Value&)> make;
  bool counts = true;
};

template <typename Value> using Table = std::vector<Change<Value>>;

template <typename Value, typename IsSame>
void ExpectDifferent(const Value& before, const Table<Value>& table, const IsSame& isSame)
{
  std::set<std::string> fields;
  EXPECT_TRUE(isSame(before, before));
  for (const Change<Value>& change : table) {
    fields.insert(change.field);
    Value after = before;
    change.make(after);
    EXPECT_EQ(isSame(before, after), !change.counts) << change.field;
    EXPECT_EQ(isSame(after, before), !change.counts) << change.field;
  }
  EXPECT_EQ(fields.size(), FieldsOf(before)) << "a line for each of them";
}

template <typename Value> void ExpectDifferent(const Value& before, const Table<Value>& table)
{
  ExpectDifferent(before, table, [](const Value& a, const Value& b) { return a == b; });
}

const std::vector<float> Depth(6, 0.5f);
const std::vector<float> OtherDepth(6, 0.25f);

std::shared_ptr<inr::TranslucentLayers> Layers(float depth)
{
  auto layers = std::make_shared<inr::TranslucentLayers>();
  layers->layers.push_back({std::vector<float>(6, depth), std::vector<glm::vec4>(6)});
  return layers;
}

/// One that has everything.
inr::Frame Full()
{
  inr::Frame frame;
  frame.width = 3;
  frame.height = 2;
  frame.opaqueDepth = Depth.data();
  frame.layers = Layers(0.5f);
  frame.clippingPlanes = {{1, 0, 0, 1}};
  frame.cropping.emplace();
  frame.piece = {{0, 1, 0, 1}};
  frame.shading.emplace();
  frame.lights.emplace_back();
  frame.errorTolerance = 1;
  return frame;
}

TEST(Frame, MakesAnotherPictureWithAnotherValueOfAnyFieldThatCounts)
{
  using inr::Frame;
  const Table<Frame> table = {
      {"width", [](Frame& frame) { frame.width = 2; }},
      {"height", [](Frame& frame) { frame.height = 1; }},
      {"clipToWorld", [](Frame& frame) { frame.clipToWorld[3].x = 1; }},
      {"worldToIndex", [](Frame& frame) { frame.worldToIndex[3].x = 1; }},
      {"worldToMedium", [](Frame& frame) { frame.worldToMedium[2].x = 1; }},
      {"opaqueDepth", [](Frame& frame) { frame.opaqueDepth = OtherDepth.data(); }},
      {"opaqueDepth", [](Frame& frame) { frame.opaqueDepth = nullptr; }},
      {"layers", [](Frame& frame) { frame.layers = Layers(0.25f); }},
      {"layers", [](Frame& frame) { frame.layers = nullptr; }},
      {"clippingPlanes", [](Frame& frame) { frame.clippingPlanes[0].w = 2; }},
      {"clippingPlanes", [](Frame& frame) { frame.clippingPlanes.clear(); }},
      {"cropping", [](Frame& frame) { frame.cropping->flags = 1; }},
      {"cropping", [](Frame& frame) { frame.cropping.reset(); }},
      {"piece", [](Frame& frame) { frame.piece[0].w = 2; }},
      {"shading", [](Frame& frame) { frame.shading->diffuse = 0.25f; }},
      {"shading", [](Frame& frame) { frame.shading.reset(); }},
      {"lights", [](Frame& frame) { frame.lights[0].color.x = 0.5f; }},
      {"lights", [](Frame& frame) { frame.lights.clear(); }},
      {"mode", [](Frame& frame) { frame.mode = inr::RenderMode::PathTracing; }},
      {"blending", [](Frame& frame) { frame.blending.mode = inr::BlendMode::Additive; }},
      {"paths", [](Frame& frame) { frame.paths.anisotropy = 0.5; }},
      {"unitDistance", [](Frame& frame) { frame.unitDistance = 2; }},
      {"sampleDistance", [](Frame& frame) { frame.sampleDistance = 2; }},
      {"adaptiveSampling", [](Frame& frame) { frame.adaptiveSampling = false; }},
      {"preIntegration", [](Frame& frame) { frame.preIntegration = true; }},
      {"levelOfDetailScale", [](Frame& frame) { frame.levelOfDetailScale = 2; }},
      {"errorTolerance", [](Frame& frame) { frame.errorTolerance = 2; }},
      {"errorTolerance", [](Frame& frame) { frame.errorTolerance = 0; }},
      {"errorTolerance", [](Frame& frame) { frame.errorTolerance.reset(); }},
      {"seed", [](Frame& frame) { frame.seed = 1; }},
      {"frameIndex", [](Frame& frame) { frame.frameIndex = 1; }},
      // How much is done for it, not what it shows.
      {"samplesPerPixel", [](Frame& frame) { frame.samplesPerPixel = 1; }, false},
      {"timeLimit", [](Frame& frame) { frame.timeLimit = 1; }, false},
      {"sharedBy", [](Frame& frame) { frame.sharedBy = 2; }, false},
      {"view", [](Frame& frame) { frame.view = 1; }, false},
      // The same, kept elsewhere.
      {"opaqueDepth", [copy = Depth](Frame& frame) { frame.opaqueDepth = copy.data(); }, false},
      {"layers", [](Frame& frame) { frame.layers = Layers(0.5f); }, false}};
  ExpectDifferent(Full(), table, inr::IsSamePicture);
}

/// Which fields of a frame of a kind make another picture.
std::set<std::string> FieldsThatCount(const inr::Frame& kind, bool cached)
{
  const Table<inr::Frame> table = {
      {"shading", [](inr::Frame& frame) { frame.shading->diffuse = 0.25f; }},
      {"lights", [](inr::Frame& frame) { frame.lights[0].color.x = 0.5f; }},
      {"paths", [](inr::Frame& frame) { frame.paths.anisotropy = 0.5; }},
      {"unitDistance", [](inr::Frame& frame) { frame.unitDistance = 2; }},
      {"sampleDistance", [](inr::Frame& frame) { frame.sampleDistance = 2; }},
      {"adaptiveSampling", [](inr::Frame& frame) { frame.adaptiveSampling = false; }},
      {"preIntegration", [](inr::Frame& frame) { frame.preIntegration = true; }},
      {"levelOfDetailScale", [](inr::Frame& frame) { frame.levelOfDetailScale = 2; }},
      {"errorTolerance", [](inr::Frame& frame) { frame.errorTolerance = 2; }},
      {"seed", [](inr::Frame& frame) { frame.seed = 1; }}};
  std::set<std::string> fields;
  for (const Change<inr::Frame>& change : table) {
    inr::Frame other = kind;
    change.make(other);
    if (!IsSamePicture(AsItIsDrawn(kind, cached), AsItIsDrawn(other, cached))) {
      fields.insert(change.field);
    }
  }
  return fields;
}

TEST(DrawnFrame, DependsOnNothingThatItsPictureDoesNot)
{
  using Fields = std::set<std::string>;
  inr::Frame frame = Full();
  frame.errorTolerance.reset();
  EXPECT_EQ(FieldsThatCount(frame, true),
            Fields({"shading", "lights", "unitDistance", "sampleDistance", "adaptiveSampling",
                    "preIntegration", "levelOfDetailScale", "errorTolerance", "seed"}));
  EXPECT_EQ(FieldsThatCount(frame, false),
            Fields({"shading", "lights", "unitDistance", "sampleDistance", "adaptiveSampling",
                    "preIntegration", "seed"}));
  const Fields always{"sampleDistance", "levelOfDetailScale", "errorTolerance", "seed"};
  for (const auto mode : {inr::BlendMode::MaximumIntensity, inr::BlendMode::MinimumIntensity,
                          inr::BlendMode::AverageIntensity}) {
    frame.blending.mode = mode;
    EXPECT_EQ(FieldsThatCount(frame, true), always);
  }
  Fields fields = always;
  fields.insert("unitDistance");
  frame.blending.mode = inr::BlendMode::Additive;
  EXPECT_EQ(FieldsThatCount(frame, true), fields);
  fields = always;
  fields.insert({"shading", "lights"});
  frame.blending.mode = inr::BlendMode::Isosurface;
  EXPECT_EQ(FieldsThatCount(frame, true), fields);
  frame.blending = {};
  frame.mode = inr::RenderMode::PathTracing;
  EXPECT_EQ(FieldsThatCount(frame, true), Fields({"lights", "paths", "unitDistance",
                                                  "levelOfDetailScale", "errorTolerance", "seed"}));
  frame.mode = inr::RenderMode::RayMarching;
  frame.shading.reset();
  inr::Frame dark = frame;
  dark.lights.clear();
  EXPECT_TRUE(IsSamePicture(AsItIsDrawn(frame, true), AsItIsDrawn(dark, true)));
}

TEST(Frame, CanBeAsItWasWithoutAnyOfWhatIsOptional) { EXPECT_TRUE(inr::IsSamePicture({}, {})); }

TEST(Frame, HasPartsThatAreOthersWithAnotherValueOfAnyField)
{
  ExpectDifferent<inr::Material>({}, {{"ambient", [](auto& m) { m.ambient = 0.5f; }},
                                      {"diffuse", [](auto& m) { m.diffuse = 0.5f; }},
                                      {"specular", [](auto& m) { m.specular = 0.5f; }},
                                      {"specularPower", [](auto& m) { m.specularPower = 2; }}});
  ExpectDifferent<inr::Light>({}, {{"kind", [](auto& l) { l.kind = inr::LightKind::Spot; }},
                                   {"position", [](auto& l) { l.position.z = 1; }},
                                   {"direction", [](auto& l) { l.direction.z = 2; }},
                                   {"color", [](auto& l) { l.color.z = 0.5f; }},
                                   {"attenuation", [](auto& l) { l.attenuation.z = 1; }},
                                   {"coneAngle", [](auto& l) { l.coneAngle = 20; }},
                                   {"exponent", [](auto& l) { l.exponent = 2; }}});
  ExpectDifferent<inr::Blending>({},
                                 {{"mode", [](auto& b) { b.mode = inr::BlendMode::Isosurface; }},
                                  {"averageLow", [](auto& b) { b.averageLow = 0; }},
                                  {"averageHigh", [](auto& b) { b.averageHigh = 0; }},
                                  {"isosurfaces", [](auto& b) { b.isosurfaces.push_back(0.5); }}});
  ExpectDifferent<inr::Cropping>({}, {{"low", [](auto& c) { c.low.y = 1; }},
                                      {"high", [](auto& c) { c.high.y = 1; }},
                                      {"flags", [](auto& c) { c.flags = 1; }}});
  ExpectDifferent<inr::PathOptions>(
      {}, {{"maximumBounces", [](auto& p) { p.maximumBounces = 1; }},
           {"scatteringAlbedo", [](auto& p) { p.scatteringAlbedo = 0.5f; }},
           {"anisotropy", [](auto& p) { p.anisotropy = 0.5; }},
           {"ambientLight", [](auto& p) { p.ambientLight.z = 1; }},
           {"emissionOnly", [](auto& p) { p.emissionOnly = true; }},
           {"rouletteAfter", [](auto& p) { p.rouletteAfter = 1; }}});
  ExpectDifferent<inr::TranslucentLayers::Layer>(
      {{0.5f}, {glm::vec4(0.5f)}},
      {{"depth", [](auto& l) { l.depth[0] = 1; }}, {"colors", [](auto& l) { l.colors[0].w = 1; }}});
}

TEST(Frame, HasLayersThatAreKnownAgainWhateverIsInThem)
{
  const auto layer = [] {
    return inr::TranslucentLayers::Layer{{std::nanf("")}, {glm::vec4(std::nanf(""))}};
  };
  EXPECT_TRUE(layer() == layer());
  EXPECT_FALSE((inr::TranslucentLayers{{layer()}}.fits(1)));
}

// A renderer is made anew when they change.
TEST(RendererOptions, AreOthersWithAnotherValueOfAnyField)
{
  ExpectDifferent<inr::RendererOptions>(
      {}, {{"threads", [](auto& o) { o.threads = 3; }},
           {"kernel", [](auto& o) { o.kernel = "scalar"; }},
           {"inference", [](auto& o) { o.inference = inr::InferencePrecision::BFloat16; }},
           {"cached", [](auto& o) { o.cached = false; }},
           {"deterministic", [](auto& o) { o.deterministic = true; }},
           {"cache", [](auto& o) { o.cache.brickSize = 8; }},
           {"accelerator", [](auto& o) {
              o.accelerator = std::make_shared<FakeAccelerator>(std::make_shared<FakeDevice>());
            }}});
  ExpectDifferent<inr::CacheOptions>(
      {}, {{"bytes", [](auto& o) { o.bytes = 1; }},
           {"precision", [](auto& o) { o.precision = inr::CachePrecision::Bits8; }},
           {"brickSize", [](auto& o) { o.brickSize = 8; }},
           {"maximumRequests", [](auto& o) { o.maximumRequests = 1; }},
           {"ranking", [](auto& o) { o.ranking = false; }},
           {"preloading", [](auto& o) { o.preloading = false; }},
           {"background", [](auto& o) { o.background = false; }},
           {"onlyWhatFits", [](auto& o) { o.onlyWhatFits = true; }}});
}

// Of what is lit, each neighbour that a sample lacks is missed.
TEST(FrameStatistics, MissNoMoreThanAll)
{
  inr::FrameStatistics statistics;
  EXPECT_EQ(statistics.hitRate(), 1);
  statistics.samples = 8;
  statistics.hidden = 2;
  statistics.missed = 4;
  EXPECT_DOUBLE_EQ(statistics.hitRate(), 0.6);
  statistics.missed = 40;
  EXPECT_EQ(statistics.hitRate(), 0);
}

} // namespace test::frame
