// SPDX-License-Identifier: BSD-3-Clause
//
// Light on many samples, by every kernel, against the formula in double, one sample at a time.
#include "Core/Render/Bricks/BrickKernel.h"
#include "Core/Render/Marching/Shading.h"
#include "Testing/Core/Kernels.h"
#include "Testing/Core/Render/KernelBricks.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace test::directional_lights {

using namespace kernel_bricks;

constexpr float Nan = std::numeric_limits<float>::quiet_NaN();
const glm::dvec3 ToEye = glm::normalize(glm::dvec3(0.3, -0.8, 0.5));
const glm::dvec3 Color(0.2, 0.6, 1.0);
constexpr float Infinity = std::numeric_limits<float>::infinity();

glm::dvec3 RandomVector() { return {Random(-1, 1), Random(-1, 1), Random(-1, 1)}; }

/// Lit by suns; a volume with voxels of this shape, turned.
inr::Frame Sunny(int suns, const glm::dvec3& spacing)
{
  inr::Frame frame;
  frame.shading =
      inr::Material{0.2f, 0.6f, 0.4f, static_cast<float>(RandomInt(0, RandomInt(0, 1) * 98 + 30))};
  for (int k = 0; k < suns; ++k) {
    inr::Light sun;
    sun.direction = RandomVector() * 5.0;
    sun.color = glm::abs(glm::vec3(RandomVector()));
    frame.lights.push_back(sun);
  }
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), double{Random(-3, 3)}, RandomVector());
  frame.worldToIndex = glm::inverse(glm::scale(turned, spacing));
  return frame;
}

/// On colour: see Shading.
glm::dvec3 Truth(const inr::Frame& frame, const glm::dvec3& color, const glm::dvec3& toEye,
                 const glm::dvec3& gradient)
{
  const inr::Material& surface = *frame.shading;
  const glm::dvec3 normal =
      glm::normalize(glm::transpose(glm::dmat3(frame.worldToIndex)) * gradient);
  glm::dvec3 light = color * double{surface.ambient};
  for (const inr::Light& sun : frame.lights) {
    const glm::dvec3 toLight = -glm::normalize(sun.direction);
    const double facing = glm::dot(normal, toLight);
    const double mirrored = glm::dot(2.0 * facing * normal - toLight, toEye);
    const double shine = mirrored > 0 ? std::pow(mirrored, double{surface.specularPower}) : 0.0;
    light += glm::dvec3(sun.color) * (double{surface.diffuse} * std::abs(facing) * color +
                                      double{surface.specular} * shine);
  }
  return light;
}

struct Batches
{
  inr::GradientBatch gradients{};
  inr::LightBatch light{};

  void set(int k, const glm::vec3& gradient)
  {
    for (int axis = 0; axis < 3; ++axis) {
      this->gradients.along[axis][k] = gradient[axis];
    }
  }

  glm::dvec3 on(const glm::dvec3& color, int k) const
  {
    glm::dvec3 lit;
    for (int channel = 0; channel < 3; ++channel) {
      lit[channel] = color[channel] * double{this->light.factor[channel][k]} +
                     double{this->light.added[channel][k]};
    }
    return lit;
  }
};

class DirectionalLights : public testing::TestWithParam<std::string>
{
protected:
  void light(const inr::Shading& shading, int count, Batches& batches) const
  {
    const float toEye[3] = {static_cast<float>(ToEye.x), static_cast<float>(ToEye.y),
                            static_cast<float>(ToEye.z)};
    this->Kernel.light(*shading.directional(), toEye, batches.gradients, count, batches.light);
  }

private:
  const inr::BrickKernel& Kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
};

TEST_P(DirectionalLights, ShineWhateverTheGradientsAndVoxels)
{
  const auto batches = std::make_unique<Batches>();
  for (const glm::dvec3& spacing :
       {glm::dvec3(1.0), glm::dvec3(0.5, 3.0, -1.2), glm::dvec3(1e-30, 2e-30, 1e-33),
        glm::dvec3(1e25, 1e-3, 1.0), glm::dvec3(1e90, 3e90, 2e90)}) {
    for (const double steepness : {1e-37, 1e-20, 1.0, 1e20, 1e38}) {
      for (int suns = 0; suns < 6; ++suns) {
        const inr::Frame frame = Sunny(suns, spacing);
        const inr::Shading shading(frame);
        ASSERT_NE(shading.directional(), nullptr);
        const int count = RandomInt(1, inr::SampleBatch::Capacity);
        std::vector<glm::vec3> gradients(count);
        for (int k = 0; k < count; ++k) {
          gradients[k] = glm::vec3(RandomVector() * steepness);
          if (k % 4 < 3) { // along one axis, which may be the longest
            gradients[k] =
                static_cast<float>(steepness) * glm::vec3(k % 4 == 0, k % 4 == 1, k % 4 == 2);
          }
          batches->set(k, gradients[k]);
        }
        this->light(shading, count, *batches);
        for (int k = 0; k < count; ++k) {
          const glm::dvec3 truth = Truth(frame, Color, ToEye, glm::dvec3(gradients[k]));
          EXPECT_LT(glm::length(batches->on(Color, k) - truth), 2e-5)
              << spacing.x << ' ' << steepness;
        }
      }
    }
  }
}

TEST_P(DirectionalLights, OfWhatHasNoDirectionAreAmbient)
{
  const inr::Frame frame = Sunny(3, {1.0, 2.0, 0.5});
  const inr::Shading shading(frame);
  const auto batches = std::make_unique<Batches>();
  const glm::vec3 none[] = {{0, 0, 0},   {Nan, 1, 2},      {1, 2, Nan},
                            {1, Nan, 2}, {Infinity, 1, 2}, {0, -Infinity, Infinity}};
  int count = 0;
  for (const glm::vec3& gradient : none) {
    batches->set(count++, gradient);
    batches->set(count++, {1, 1, 1}); // neighbours do not mind
  }
  this->light(shading, count, *batches);
  const glm::dvec3 lit = Truth(frame, Color, ToEye, glm::dvec3(1.0));
  const double ambient = frame.shading->ambient;
  for (int k = 0; k < count; k += 2) {
    const glm::vec3& gradient = none[k / 2];
    EXPECT_EQ(batches->on(Color, k), Color * ambient) << k;
    EXPECT_EQ(shading.view().shade(glm::vec3(1), ToEye, {}, gradient), glm::vec3(0.2f)) << k;
    EXPECT_LT(glm::length(batches->on(Color, k + 1) - lit), 2e-5) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, DirectionalLights, testing::ValuesIn(UsableKernels()),
                         [](const auto& info) { return info.param; });

TEST(DirectionalLights, AreAllThereIsWithoutLamps)
{
  inr::Frame frame = Sunny(2, glm::dvec3(1.0));
  const auto areAll = [&] { return inr::Shading(frame).directional() != nullptr; };
  EXPECT_TRUE(areAll());
  frame.shading->specularPower = 2.5f; // which squaring does not make
  EXPECT_FALSE(areAll());
  for (const float large : {129.0f, 1e30f}) {
    frame.shading->specularPower = large;
    EXPECT_FALSE(areAll());
  }
  frame.shading->specularPower = 128;
  EXPECT_TRUE(areAll());
  frame.shading->specularPower = 129;
  frame.shading->specular = 0.0f;
  EXPECT_TRUE(areAll());
  frame.lights[1].kind = inr::LightKind::Point;
  EXPECT_FALSE(areAll());
}

TEST(DirectionalLights, StayWhereAShadingIsMovedTo)
{
  const inr::Frame frame = Sunny(4, glm::dvec3(1.0));
  inr::Shading first(frame);
  const inr::DirectionalLight* const lights = first.directional()->lights;
  const inr::Shading moved = std::move(first);
  ASSERT_NE(moved.directional(), nullptr);
  EXPECT_EQ(moved.directional()->lights, lights);
  EXPECT_EQ(moved.directional()->count, 4);
}

} // namespace test::directional_lights
