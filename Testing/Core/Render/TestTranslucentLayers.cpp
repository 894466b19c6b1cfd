// SPDX-License-Identifier: BSD-3-Clause
//
// Truth: the parts of the volume in front of and behind a surface, rendered apart (clipped by a
// plane), and the surface, laid over each other by hand.
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Testing/Core/Render/PathScene.h"
#include "Testing/Core/Render/VoxelScene.h"

namespace test::translucent_layers {

using Layers = std::shared_ptr<inr::TranslucentLayers>;

const glm::vec4 Glass(0.1f, 0.3f, 0.2f, 0.4f); // premultiplied
const glm::i64vec3 Dims(33, 46, 21);

/// Window depth of the plane z = `place` in a parallel view from z = -10 to 40.
float DepthAt(double place) { return static_cast<float>((place + 10.0) / 50.0); }

inr::Frame View()
{
  inr::Frame frame = ParallelFrame(24, {-2, -2}, {35, 48}, -10, 40);
  frame.sampleDistance = 0.05; // the parts' samples are not the whole's
  frame.adaptiveSampling = false;
  frame.levelOfDetailScale = 0;
  frame.unitDistance = 1;
  return frame;
}

void AddSurface(inr::Frame& frame, double place, const glm::vec4& color)
{
  AddLayer(frame, DepthAt(place), color);
}

glm::vec4 Over(const glm::vec4& front, const glm::vec4& back)
{
  return front + (1.0f - front.w) * back;
}

glm::vec4 Pixel(const inr::Image& image, std::size_t k)
{
  const float* p = &image.pixels[4 * k];
  return {p[0], p[1], p[2], p[3]};
}

/// What the window shows: the picture over the surfaces.
std::vector<glm::vec4> Shown(inr::Renderer& renderer, const inr::Frame& frame)
{
  const inr::Image picture = Render(renderer, frame);
  const inr::RayGeometry geometry(frame, Dims);
  std::vector<glm::vec4> shown;
  for (std::size_t k = 0; k < picture.pixels.size() / 4; ++k) {
    const inr::Veil surfaces = geometry.view().layers.inFrontOf(1.0, static_cast<std::int64_t>(k));
    shown.push_back(Over(Pixel(picture, k), glm::vec4(surfaces.color, 1.0f - surfaces.passes)));
  }
  return shown;
}

/// The volume between two planes z = ..., alone.
inr::Image Slab(inr::Renderer& renderer, double low, double high)
{
  inr::Frame frame = View();
  frame.clippingPlanes = {glm::dvec4(0, 0, 1, -low), glm::dvec4(0, 0, -1, high)};
  return Render(renderer, frame);
}

void ExpectClose(const std::vector<glm::vec4>& shown, const std::vector<glm::vec4>& truth,
                 float tolerance)
{
  ASSERT_EQ(shown.size(), truth.size());
  float largest = 0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    for (int channel = 0; channel < 4; ++channel) {
      largest = std::max(largest, std::abs(shown[k][channel] - truth[k][channel]));
    }
  }
  EXPECT_LT(largest, tolerance);
}

/// The scene with surfaces at `places`, made at once and by hand.
void CompareWithParts(inr::Renderer& renderer, const std::vector<double>& places, float tolerance)
{
  inr::Frame frame = View();
  for (const double place : places) {
    AddSurface(frame, place, Glass);
  }
  std::vector<glm::vec4> truth(static_cast<std::size_t>(frame.width) * frame.height);
  for (std::size_t part = places.size() + 1; part-- > 0;) {
    const double low = part > 0 ? places[part - 1] : -100;
    const double high = part < places.size() ? places[part] : 100;
    const inr::Image slab = Slab(renderer, low, high);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      truth[k] = Over(Pixel(slab, k), part < places.size() ? Over(Glass, truth[k]) : truth[k]);
    }
  }
  ExpectClose(Shown(renderer, frame), truth, tolerance);
}

const std::vector<std::vector<double>> Scenes = {{-5}, {30}, {8.3}, {4, 4.2, 16}, {-3, 9, 9, 35}};

TEST(TranslucentLayers, AreCompositedInTheirPlacesFromTheCache)
{
  inr::Renderer renderer = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 9));
  for (const auto& places : Scenes) {
    CompareWithParts(renderer, places, 4e-3f);
  }
}

TEST(TranslucentLayers, AreCompositedInTheirPlacesFromTheNetwork)
{
  inr::Renderer renderer = FieldRenderer(Dims, Waves);
  renderer.setTransferFunction(Colours());
  for (const auto& places : Scenes) {
    CompareWithParts(renderer, places, 4e-3f);
  }
}

TEST(TranslucentLayers, OfNothingChangeNothing)
{
  inr::Renderer renderer = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 9));
  inr::Frame frame = View();
  const inr::Image alone = Render(renderer, frame);
  AddSurface(frame, 100, {}); // at depth above 1
  EXPECT_LT(inr::ImageMaximumError(Render(renderer, frame), alone), 1e-6f);
}

TEST(TranslucentLayers, ThatLetNothingThroughEndTheRay)
{
  inr::Renderer renderer = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 9));
  inr::Frame frame = View();
  AddSurface(frame, 8, glm::vec4(0.2f, 0.4f, 0.6f, 1.0f));
  inr::Frame cut = View();
  const std::vector<float> depth(static_cast<std::size_t>(cut.width) * cut.height, DepthAt(8));
  cut.opaqueDepth = depth.data();
  const inr::Image front = Render(renderer, cut);
  std::vector<glm::vec4> truth;
  for (std::size_t k = 0; k < depth.size(); ++k) {
    truth.push_back(Over(Pixel(front, k), {0.2f, 0.4f, 0.6f, 1.0f}));
  }
  ExpectClose(Shown(renderer, frame), truth, 1e-4f);
}

TEST(TranslucentLayers, DoNotMoveTheDepthOfTheVolume)
{
  inr::Renderer renderer = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 9));
  renderer.setTransferFunction(UniformMedium(0.2f));
  inr::Frame frame = View();
  inr::Image alone(frame.width, frame.height, 1);
  inr::Image layered(frame.width, frame.height, 1);
  inr::Image rgba;
  renderer.render(frame, rgba, &alone);
  AddSurface(frame, 1, Glass);
  AddSurface(frame, 12, Glass);
  renderer.render(frame, rgba, &layered);
  EXPECT_LT(inr::ImageMaximumError(alone, layered), 0.1f / 50);
}

TEST(TranslucentLayers, AreSeenInFrontOfTheFirstCollisionOfPaths)
{
  inr::Renderer renderer = CachedRenderer(Dims, Waves, Options(inr::CachePrecision::Float32, 9));
  renderer.setTransferFunction(UniformMedium(0.1f, glm::vec3(0.8f, 0.5f, 0.3f)));
  inr::Frame marched = View();
  AddSurface(marched, 5, Glass);
  AddSurface(marched, 12, Glass);
  inr::Frame traced = marched;
  traced.mode = inr::RenderMode::PathTracing;
  traced.paths.emissionOnly = true;
  traced.samplesPerPixel = 400;
  const std::vector<glm::vec4> truth = Shown(renderer, marched);
  const std::vector<glm::vec4> shown = Shown(renderer, traced);
  glm::dvec4 difference(0);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    difference += glm::dvec4(shown[k] - truth[k]) / static_cast<double>(truth.size());
  }
  for (int channel = 0; channel < 4; ++channel) {
    EXPECT_NEAR(difference[channel], 0, 2e-3) << channel;
  }
}

TEST(TranslucentLayers, StartAnotherPictureWhenTheyChange)
{
  inr::Frame a = View();
  inr::Frame b = View();
  AddSurface(a, 5, Glass);
  EXPECT_FALSE(inr::IsSamePicture(a, b));
  AddSurface(b, 5, Glass);
  EXPECT_TRUE(inr::IsSamePicture(a, b));
  AddSurface(b, 6, Glass);
  EXPECT_FALSE(inr::IsSamePicture(a, b));
}

TEST(TranslucentLayers, OfAnotherSizeOrOrderAreRefused)
{
  inr::Renderer renderer = FieldRenderer(Dims, Waves);
  renderer.setTransferFunction(Colours());
  inr::Frame frame = View();
  AddSurface(frame, 5, Glass);
  AddSurface(frame, 3, Glass);
  EXPECT_THROW(Render(renderer, frame), inr::Error);
  frame.layers = nullptr;
  AddSurface(frame, 3, Glass);
  frame.width -= 1;
  EXPECT_THROW(Render(renderer, frame), inr::Error);
  frame.width += 1;
  frame.blending.mode = inr::BlendMode::MaximumIntensity;
  EXPECT_THROW(Render(renderer, frame), inr::Error);
}

} // namespace test::translucent_layers
