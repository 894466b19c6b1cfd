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

namespace test::diffuse_lights {

using namespace kernel_bricks;

constexpr float Nan = std::numeric_limits<float>::quiet_NaN();
constexpr float Infinity = std::numeric_limits<float>::infinity();

glm::dvec3 RandomVector() { return {Random(-1, 1), Random(-1, 1), Random(-1, 1)}; }

/// Without highlights, lit by suns; a volume with voxels of this shape, turned.
inr::Frame Sunny(int suns, const glm::dvec3& spacing)
{
  inr::Frame frame;
  frame.shading = inr::Material{0.2f, 0.6f, 0.0f, 8.0f};
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

glm::dvec3 Truth(const inr::Frame& frame, const glm::dvec3& gradient)
{
  const inr::Material& surface = *frame.shading;
  const glm::dvec3 across = glm::transpose(glm::dmat3(frame.worldToIndex)) * gradient;
  glm::dvec3 light(surface.ambient);
  for (const inr::Light& sun : frame.lights) {
    const double facing = glm::dot(glm::normalize(across), glm::normalize(sun.direction));
    light += double{surface.diffuse} * std::abs(facing) * glm::dvec3(sun.color);
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

  glm::dvec3 of(int k) const
  {
    return {this->light.rgb[0][k], this->light.rgb[1][k], this->light.rgb[2][k]};
  }
};

class DiffuseLights : public testing::TestWithParam<std::string>
{
protected:
  const inr::BrickKernel& Kernel = inr::BrickKernelFor(inr::ChooseInstructionSet(GetParam()));
};

TEST_P(DiffuseLights, ShineWhateverTheGradientsAndVoxels)
{
  const auto batches = std::make_unique<Batches>();
  for (const glm::dvec3& spacing :
       {glm::dvec3(1.0), glm::dvec3(0.5, 3.0, -1.2), glm::dvec3(1e-30, 2e-30, 1e-33),
        glm::dvec3(1e25, 1e-3, 1.0), glm::dvec3(1e90, 3e90, 2e90)}) {
    for (const double steepness : {1e-37, 1e-20, 1.0, 1e20, 1e38}) {
      for (int suns = 0; suns < 6; ++suns) {
        const inr::Frame frame = Sunny(suns, spacing);
        const inr::Shading shading(frame);
        ASSERT_NE(shading.diffuse(), nullptr);
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
        this->Kernel.light(*shading.diffuse(), batches->gradients, count, batches->light);
        for (int k = 0; k < count; ++k) {
          const glm::dvec3 truth = Truth(frame, glm::dvec3(gradients[k]));
          EXPECT_LT(glm::length(batches->of(k) - truth), 3e-6) << spacing.x << ' ' << steepness;
        }
      }
    }
  }
}

TEST_P(DiffuseLights, OfWhatHasNoDirectionAreAmbient)
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
  this->Kernel.light(*shading.diffuse(), batches->gradients, count, batches->light);
  const glm::dvec3 lit = Truth(frame, glm::dvec3(1.0));
  const glm::vec3 white(1.0f);
  for (int k = 0; k < count; k += 2) {
    const glm::vec3& gradient = none[k / 2];
    EXPECT_EQ(batches->of(k), glm::dvec3(frame.shading->ambient)) << k;
    EXPECT_EQ(shading.view().shade(white, {0, 0, 1}, {}, gradient), white * 0.2f) << k;
    EXPECT_LT(glm::length(batches->of(k + 1) - lit), 3e-6) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, DiffuseLights, testing::ValuesIn(UsableKernels()),
                         [](const auto& info) { return info.param; });

TEST(DiffuseLights, AreAllThereIsWithoutHighlightsAndLamps)
{
  inr::Frame frame = Sunny(2, glm::dvec3(1.0));
  EXPECT_NE(inr::Shading(frame).diffuse(), nullptr);
  frame.shading->specular = 0.1f;
  EXPECT_EQ(inr::Shading(frame).diffuse(), nullptr);
  frame.shading->specular = 0.0f;
  frame.lights[1].kind = inr::LightKind::Point;
  EXPECT_EQ(inr::Shading(frame).diffuse(), nullptr);
}

TEST(DiffuseLights, StayWhereAShadingIsMovedTo)
{
  const inr::Frame frame = Sunny(4, glm::dvec3(1.0));
  inr::Shading first(frame);
  const inr::DiffuseLight* const lights = first.diffuse()->lights;
  const inr::Shading moved = std::move(first);
  ASSERT_NE(moved.diffuse(), nullptr);
  EXPECT_EQ(moved.diffuse()->lights, lights);
  EXPECT_EQ(moved.diffuse()->count, 4);
}

} // namespace test::diffuse_lights
