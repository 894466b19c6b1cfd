// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Error.h"
#include "Core/Image/Metrics.h"
#include "Core/Render/Marching/Shading.h"
#include "Testing/Core/Render/VoxelScene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>

namespace test::shading {

inr::Light Sun(const glm::dvec3& direction, const glm::vec3& color = glm::vec3(1))
{
  inr::Light light;
  light.direction = direction;
  light.color = color;
  return light;
}

inr::Frame Lit(const glm::dvec3& dims, int size)
{
  inr::Frame frame = Oblique(dims, size);
  frame.shading = inr::Material{0.2f, 0.6f, 0.4f, 8.0f};
  inr::Light lamp;
  lamp.kind = inr::LightKind::Point;
  lamp.position = dims * glm::dvec3(1.5, 2.0, 0.3);
  lamp.color = glm::vec3(0.9f, 0.5f, 0.2f);
  frame.lights = {lamp, Sun({-1, -2, -3}), Sun({2, 0.3, 1}, glm::vec3(0.1f, 0.2f, 0.4f))};
  return frame;
}

/// Without the lamp, so that kernels shade.
inr::Frame Sunny(const glm::dvec3& dims, int size)
{
  inr::Frame frame = Lit(dims, size);
  frame.lights.erase(frame.lights.begin());
  return frame;
}

/// The formula, written out in double for a surface with unit normal n.
glm::dvec3 Truth(const inr::Material& m, const glm::dvec3& color, const glm::dvec3& n,
                 const glm::dvec3& l, const glm::dvec3& v, const glm::dvec3& light)
{
  const glm::dvec3 r = 2.0 * glm::dot(n, l) * n - l;
  const double shine = std::pow(std::max(glm::dot(r, v), 0.0), double{m.specularPower});
  return double{m.ambient} * color + light * (double{m.diffuse} * std::abs(glm::dot(n, l)) * color +
                                              double{m.specular} * shine);
}

TEST(Shading, FollowsTheFormulaWhateverTheVolumesShape)
{
  inr::Frame frame;
  frame.shading = inr::Material{0.3f, 0.5f, 0.7f, 5.0f};
  const glm::dvec3 light = glm::normalize(glm::dvec3(1, -0.4, 0.2)); // into which it shines
  frame.lights = {Sun(3.0 * light, glm::vec3(0.8f, 1.0f, 0.5f))};
  // Stretched, turned and moved.
  const glm::dmat4 indexToWorld =
      glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(100, -7, 3)), 0.7,
                  glm::dvec3(1, 2, 3)) *
      glm::scale(glm::dmat4(1.0), glm::dvec3(0.5, 3.0, -1.2));
  frame.worldToIndex = glm::inverse(indexToWorld);
  const inr::Shading shading(frame);
  inr::Ray ray;
  ray.direction = glm::dvec3(0.3, 0.2, 1.0);
  const glm::dvec3 toEye = -glm::normalize(glm::dmat3(indexToWorld) * ray.direction);

  // A field that rises along a world direction: its slope along an index axis is how far a step
  // along that axis leads along the direction.
  const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.6, 0.9, 0.3));
  glm::vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    gradient[axis] = static_cast<float>(glm::dot(normal, glm::dvec3(indexToWorld[axis])));
  }
  const glm::vec3 color(0.2f, 0.6f, 1.0f);
  const glm::vec3 shaded =
      shading.view().shade(color, shading.view().toEye(ray), glm::dvec3(1, 2, 3), gradient);
  const glm::dvec3 truth = Truth(*frame.shading, glm::dvec3(color), normal, -light, toEye,
                                 glm::dvec3(frame.lights[0].color));
  EXPECT_LT(glm::length(glm::dvec3(shaded) - truth), 1e-6);
  // Both sides are lit alike, and what has no slope gets the ambient part.
  EXPECT_LT(
      glm::length(shading.view().shade(color, shading.view().toEye(ray), {}, -gradient) - shaded),
      1e-6f);
  EXPECT_EQ(shading.view().shade(color, shading.view().toEye(ray), {}, glm::vec3(0)), 0.3f * color);
}

TEST(Shading, KnowsWhereLightsAre)
{
  inr::Frame frame;
  frame.shading = inr::Material{0.3f, 0.5f, 0.7f, 5.0f};
  inr::Light lamp;
  lamp.kind = inr::LightKind::Point;
  lamp.position = {4, -3, 20};
  lamp.color = glm::vec3(0.8f, 1.0f, 0.5f);
  frame.lights = {lamp};
  const inr::Shading shading(frame);
  inr::Ray ray;
  ray.direction = glm::dvec3(0.3, 0.2, 1.0);
  const glm::dvec3 toEye = -glm::normalize(ray.direction);
  const glm::vec3 color(0.2f, 0.6f, 1.0f);
  const glm::vec3 gradient(-1, 2, 0.5f);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(gradient));
  for (const glm::dvec3& index : {glm::dvec3(1, 2, 3), glm::dvec3(-7, 5, 30)}) {
    const glm::dvec3 truth =
        Truth(*frame.shading, glm::dvec3(color), normal, glm::normalize(lamp.position - index),
              toEye, glm::dvec3(lamp.color));
    const glm::vec3 shaded =
        shading.view().shade(color, shading.view().toEye(ray), index, gradient);
    EXPECT_LT(glm::length(glm::dvec3(shaded) - truth), 1e-6);
  }
}

TEST(Shading, OfARampIsThatOfItsDirection)
{
  const glm::i64vec3 dims(20, 20, 20);
  const auto ramp = [](const glm::vec3& u) { return 0.2f + 0.5f * u.z + 0.1f * u.x; };
  inr::Frame frame = ParallelFrame(8, {2, 2}, {17, 17}, -5, 30);
  frame.shading = inr::Material{0.1f, 0.7f, 0.0f, 1.0f};
  frame.lights = {Sun({0, 0, 1})};
  const float facing = 0.5f / std::sqrt(0.26f);
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(dims, ramp, {}, 2, cached);
    renderer.setTransferFunction(UniformMedium(0.05f, glm::vec3(0.5f, 1.0f, 0.25f)));
    const inr::Image image = Render(renderer, frame);
    for (int x = 0; x < 8; ++x) {
      const float* pixel = image.pixel(x, 3);
      EXPECT_GT(pixel[3], 0.5f);
      EXPECT_NEAR(pixel[0] / pixel[3], 0.5f * (0.1f + 0.7f * facing), 1e-4f) << cached;
      EXPECT_NEAR(pixel[1] / pixel[3], 0.1f + 0.7f * facing, 1e-4f) << cached;
    }
  }
}

TEST(Shading, ThroughTheCacheEqualsThatOverTheDenseVoxels)
{
  for (const auto& frame : {Lit, Sunny}) {
    CompareWithDense([&](const glm::dvec3& dims) { return frame(dims, 48); },
                     [](const inr::Image& cached, const inr::Image& dense) {
                       EXPECT_GT(inr::ImagePsnr(cached, dense), 75);
                       EXPECT_LT(inr::ImageMaximumError(cached, dense), 2e-2f);
                     });
  }
}

TEST(Shading, DoesSoWithColoursOnALogarithmicScale)
{
  const glm::i64vec3 dims(33, 46, 21);
  const Voxels voxels(dims, Waves);
  inr::TransferFunction colours = Colours();
  colours.logarithmic = true;
  colours.low = 0.02;
  inr::Renderer dense = FieldRenderer(
      dims, [&](const glm::vec3& u) { return voxels.at(u); }, {}, 2);
  inr::Renderer cached = CachedRenderer(dims, Waves, Options(inr::CachePrecision::Float32, 9));
  dense.setTransferFunction(colours);
  cached.setTransferFunction(colours);
  const inr::Frame frame = Lit(glm::dvec3(dims), 48);
  const inr::Image truth = Render(dense, frame);
  EXPECT_GT(*std::max_element(truth.pixels.begin(), truth.pixels.end()), 0.3f);
  EXPECT_GT(inr::ImagePsnr(Render(cached, frame), truth), 60);
}

TEST(Shading, WithoutLightButAmbientIsNone)
{
  const glm::i64vec3 dims(33, 46, 21);
  inr::Frame frame = Oblique(glm::dvec3(dims));
  for (const bool cached : {false, true}) {
    inr::Renderer renderer = FieldRenderer(dims, Waves, {}, 2, cached);
    renderer.setTransferFunction(Colours());
    frame.shading.reset();
    const inr::Image plain = Render(renderer, frame);
    frame.shading = inr::Material{1.0f, 0.7f, 0.3f, 3.0f};
    EXPECT_LT(inr::ImageMaximumError(Render(renderer, frame), plain), 3e-4f) << cached;
    frame.lights = {Sun({1, 1, 1})};
    EXPECT_GT(inr::ImageMaximumError(Render(renderer, frame), plain), 0.05f) << cached;
    frame.lights.clear();
  }
}

TEST(Shading, ThePictureDoesNotDependOnTheSizeOfTheCacheOrOnThreads)
{
  const glm::i64vec3 dims(90, 70, 80);
  const auto picture = [&](const inr::Frame& frame, std::int64_t bytes, int threads) {
    inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 8);
    options.bytes = bytes;
    inr::Renderer renderer = CachedRenderer(dims, Waves, options, threads);
    return Render(renderer, frame).pixels;
  };
  inr::Frame frame = Lit(glm::dvec3(dims), 120);
  frame.levelOfDetailScale = 1.5; // several levels at once
  const std::vector<float> truth = picture(frame, 64 << 20, 1);
  EXPECT_EQ(picture(frame, 64 << 20, 3), truth);
  EXPECT_EQ(picture(frame, 400000, 2), truth); // a few hundred bricks of thousands

  frame = Lit(glm::dvec3(dims), 16);
  for (const std::int64_t bytes : {13000, 15000, 17000}) { // from the fewest bricks on
    EXPECT_EQ(picture(frame, bytes, 1), picture(frame, 64 << 20, 1));
  }
}

TEST(Shading, FramesInALimitedTimeEndWithTheCompletePicture)
{
  const glm::i64vec3 dims(90, 70, 80);
  inr::Frame frame = Lit(glm::dvec3(dims), 100);
  inr::CacheOptions options = Options(inr::CachePrecision::Bits16, 16);
  inr::Renderer complete = CachedRenderer(dims, Waves, options);
  const inr::Image truth = Render(complete, frame);
  frame.timeLimit = 0.01;
  for (const std::int64_t bytes : {std::int64_t{64} << 20, std::int64_t{500000}}) {
    options.bytes = bytes;
    inr::Renderer hurried = CachedRenderer(dims, Waves, options);
    inr::Image image;
    int frames = 1;
    while (!hurried.render(frame, image).complete && frames < 3000) {
      ++frames;
    }
    EXPECT_GT(frames, 1);
    EXPECT_EQ(image.pixels, truth.pixels);
  }
}

TEST(Shading, RefusesMaterialsThatAreNone)
{
  const glm::i64vec3 dims(8, 8, 8);
  inr::Renderer renderer = FieldRenderer(dims, Waves);
  renderer.setTransferFunction(Colours());
  inr::Frame frame = Lit(glm::dvec3(dims), 48);
  frame.shading->diffuse = -1;
  EXPECT_THROW(Render(renderer, frame), inr::Error);
  frame.shading = inr::Material{};
  frame.shading->specularPower = std::nanf("");
  EXPECT_THROW(Render(renderer, frame), inr::Error);
}

/// As paths do; what nothing is lit by may be anything.
TEST(Shading, RefusesLightsThatAreNone)
{
  const glm::i64vec3 dims(8, 8, 8);
  inr::Renderer renderer = FieldRenderer(dims, Waves);
  renderer.setTransferFunction(Colours());
  inr::Light aimless;
  aimless.direction = glm::dvec3(0.0);
  inr::Light endless;
  endless.kind = inr::LightKind::Point;
  endless.attenuation = glm::dvec3(0.0);
  inr::Light colorless;
  colorless.color.y = std::nanf("");
  inr::Light placeless; // which it does not need, but is known by
  placeless.position.x = std::nan("");
  for (const inr::Light& light : {aimless, endless, colorless, placeless}) {
    inr::Frame frame = Lit(glm::dvec3(dims), 48);
    frame.lights = {light};
    EXPECT_THROW(Render(renderer, frame), inr::Error);
    frame.shading.reset();
    EXPECT_NO_THROW(Render(renderer, frame));
  }
}

} // namespace test::shading
