// SPDX-License-Identifier: BSD-3-Clause
//
// Paths through media that are next to nothing or next to solid, and scatter forwards or backwards
// only: against closed forms.
#include "Testing/Core/Render/PathScene.h"

namespace test::extreme_paths {

/// A homogeneous medium of some optical depth along the view.
PathTest& OfDepth(PathTest& test, double depth)
{
  const float opacity = test.colors.lookup().at(0.5f).w;
  test.frame.unitDistance = 16 * -std::log1p(-static_cast<double>(opacity)) / depth;
  return test;
}

/// Chandrasekhar's H for isotropic scattering of the given albedo, at 1: "Radiative Transfer"
/// (1950), chapter V.
double HOfOne(double albedo)
{
  constexpr int nodes = 500;
  std::vector<double> h(nodes, 1.0);
  const auto at = [](int k) { return (k + 0.5) / nodes; };
  const auto next = [&](double mu) {
    double sum = 0;
    for (int k = 0; k < nodes; ++k) {
      sum += at(k) * h[static_cast<std::size_t>(k)] / (mu + at(k)) / nodes;
    }
    return 1.0 / (std::sqrt(1 - albedo) + 0.5 * albedo * sum);
  };
  for (int round = 0; round < 30; ++round) {
    std::vector<double> better(nodes);
    for (int k = 0; k < nodes; ++k) {
      better[static_cast<std::size_t>(k)] = next(at(k));
    }
    h = better;
  }
  return next(1.0);
}

TEST(ExtremePaths, OfFaintMediaCollideAsOftenAsTheyShould)
{
  for (const float opacity : {0.1f, 1e-7f}) {
    PathTest test({17, 17, 17}, Constant, UniformMedium(opacity));
    OfDepth(test, 1e-4).frame.width = 512;
    test.frame.height = 512;
    EXPECT_LT(std::abs(test.estimate(3, 3).z(1e-4)), Unlikely) << opacity;
  }
  PathTest test({17, 17, 17}, Constant, UniformMedium(0.1f));
  OfDepth(test, 1e-6).frame.width = 1024;
  test.frame.height = 1024;
  const double collisions = test.estimate(3, 4).mean * 4 * 1024 * 1024;
  EXPECT_GE(collisions, 1);  // 4.2 are expected, none once in 66 times,
  EXPECT_LE(collisions, 12); // more once in 2,000
}

TEST(ExtremePaths, OfNearlySolidMediaAreReflectedAsByAHalfSpace)
{
  for (const float albedo : {0.5f, 0.95f}) {
    PathTest test({17, 17, 17}, Constant, UniformMedium(0.9f));
    OfDepth(test, 1e6).options.ambientLight = glm::vec3(1.0f);
    test.options.scatteringAlbedo = albedo;
    test.options.maximumBounces = 100000;
    test.options.rouletteAfter = 8;
    const Estimate found = test.estimate(0, 40);
    const double truth = 1 - HOfOne(albedo) * std::sqrt(1 - static_cast<double>(albedo));
    EXPECT_LT(std::abs(found.z(truth)), Unlikely) << found.mean << " " << truth;
    EXPECT_LT(found.error, 0.01);
    EXPECT_EQ(test.estimate(3, 1).mean, 1.0);
  }
}

TEST(ExtremePaths, ConserveLightHoweverTheyScatter)
{
  for (const double depth : {1e-6, 1.0, 50.0}) {
    for (const double anisotropy : {-0.99, 0.99}) {
      PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
      OfDepth(test, depth).options.anisotropy = anisotropy;
      test.options.maximumBounces = 1 << 30;
      test.options.ambientLight = {0.75f, 0.5f, 0.25f};
      const inr::Image image = test.picture(5);
      for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
        const float alpha = image.pixels[k + 3];
        EXPECT_TRUE(alpha == 0.0f || alpha == 1.0f);
        EXPECT_EQ(image.pixels[k], 0.75f * alpha);
        EXPECT_EQ(image.pixels[k + 2], 0.25f * alpha);
      }
    }
  }
}

// However thick: what has left carries all its light, and nothing has more.
TEST(ExtremePaths, LoseNoLightInNearlySolidMedia)
{
  for (const double anisotropy : {-0.99, 0.0, 0.99}) {
    PathTest test({17, 17, 17}, Constant, UniformMedium(0.9f));
    OfDepth(test, 1e6).options.anisotropy = anisotropy;
    test.options.maximumBounces = 3000;
    test.options.ambientLight = glm::vec3(0.5f);
    const inr::Image image = test.picture(1);
    double left = 0;
    for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
      EXPECT_TRUE(image.pixels[k] == 0.0f || image.pixels[k] == 0.5f);
      EXPECT_EQ(image.pixels[k + 3], 1.0f);
      left += image.pixels[k] / 0.5;
    }
    EXPECT_GT(left / (32 * 32), anisotropy > 0.5 ? 0.7 : 0.95);
  }
}

TEST(ExtremePaths, SendNothingBackWithoutAlbedo)
{
  for (const double depth : {1e-6, 1.0, 1e6}) {
    PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
    OfDepth(test, depth).options.scatteringAlbedo = 0;
    test.options.ambientLight = glm::vec3(1.0f);
    test.lights = {inr::Light{}};
    const inr::Image image = test.picture(0);
    for (std::size_t k = 0; k < image.pixels.size(); k += 4) {
      EXPECT_EQ(image.pixels[k], 0.0f);
    }
  }
}

/// A light that shines along the view or against it.
inr::Light Along(double z)
{
  inr::Light light;
  light.direction = {0, 0, z};
  return light;
}

TEST(ExtremePaths, ScatterOnceAsTheFormulaSays)
{
  for (const double anisotropy : {-0.99, 0.99}) {
    for (const double depth : {0.01, 1.0, 1e6}) {
      PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
      OfDepth(test, depth).options.anisotropy = anisotropy;
      test.options.maximumBounces = 1;
      test.options.scatteringAlbedo = 0.5f;
      const double light = 0.5 * 3.14159265358979324; // albedo times irradiance

      test.lights = {Along(1)}; // from behind the camera: everything turns round
      const double back = light * inr::PhaseDensity(anisotropy, -1);
      const Estimate turned = test.estimate(0, 40);
      EXPECT_LT(std::abs(turned.z(back * -0.5 * std::expm1(-2 * depth))), Unlikely)
          << anisotropy << " " << depth;

      test.lights = {Along(-1)}; // through the medium
      const double ahead = light * inr::PhaseDensity(anisotropy, 1);
      const double passed = ahead * depth * std::exp(-depth);
      const Estimate through = test.estimate(0, 40);
      EXPECT_LT(std::abs(through.mean - passed), Unlikely * through.error + 1e-9)
          << anisotropy << " " << depth;
    }
  }
}

// A path gathers light where it scatters, never more than all of a light's that the phase function
// turns towards it.
TEST(ExtremePaths, CarryNoMoreThanTheLightsGive)
{
  for (const double anisotropy : {-0.99, 0.0, 0.99}) {
    for (const double depth : {0.1, 1e6}) {
      PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
      OfDepth(test, depth).options.anisotropy = anisotropy;
      test.options.maximumBounces = 12;
      test.lights = {Along(1), Along(-1)};
      const double most =
          2 * 3.14159265358979324 * inr::PhaseDensity(anisotropy, anisotropy < 0 ? -1 : 1);
      for (std::uint64_t k = 0; k < 20; ++k) {
        for (const float value : test.picture(k).pixels) {
          EXPECT_GE(value, 0.0f); // and is a number
          EXPECT_LE(value, 1.00001 * 12 * std::max(most, 1.0));
        }
      }
    }
  }
}

} // namespace test::extreme_paths
