// SPDX-License-Identifier: BSD-3-Clause
//
// Paths that bring back more than they may. A path's weight is the product of the colours and
// albedos that it met, and chance never makes it more than 1: of weight w < 1 a path goes on with
// the chance w, and then has 1. As chance decides from scattering R + 1 on, of colours times albedo
// up to a <= 1 a path has at most the weight
//
//   t(b) = a^b up to scattering b = R, and 1 behind it.
//
// At each it looks at one of L lights, which counts L times; what passes on the way is between 0
// and 1, by chance, too. So with irradiances up to E, a phase function up to p and n scatterings,
//
//   radiance  <=  L E p (t(1) + ... + t(n))  +  largest t times the ambient light.
//
// The estimator can reach this, so nothing less can be asked for. How often it comes near is for
// its variance to say, which single scattering has in closed form.
#include "Testing/Core/Render/PathScene.h"
#include "Testing/Core/Render/ToleranceScene.h"

#include <glm/geometric.hpp>

namespace test::fireflies {

constexpr double Pi = 3.14159265358979323846;

/// A light that shines along the view or against it.
inr::Light Along(double z, const glm::vec3& color = glm::vec3(1))
{
  inr::Light light;
  light.direction = {0, 0, z};
  light.color = color;
  return light;
}

/// Of one channel; `color`: the largest of the medium's.
double MostOfAPath(const PathTest& test, int channel, double color)
{
  const inr::PathOptions& options = test.options;
  double weight = 1;
  double sum = 0;
  double largest = 0;
  for (int bounce = 1; bounce <= options.maximumBounces; ++bounce) {
    weight = bounce <= options.rouletteAfter
                 ? weight * color * static_cast<double>(options.scatteringAlbedo)
                 : 1.0;
    sum += weight;
    largest = std::max(largest, weight);
  }
  double irradiance = 0;
  for (const inr::Light& light : test.lights) {
    irradiance = std::max(irradiance, Pi * static_cast<double>(light.color[channel]));
  }
  const double g = options.anisotropy;
  return static_cast<double>(test.lights.size()) * irradiance *
             inr::PhaseDensity(g, g < 0 ? -1 : 1) * sum +
         largest * static_cast<double>(options.ambientLight[channel]);
}

/// Of optical depth 1 along the view where the opacity is that.
void SetDepth(PathTest& test, double opacity, double depth)
{
  test.frame.unitDistance = 16 * -std::log1p(-opacity) / depth;
}

float LargestOf(PathTest& test, int channel, int frames)
{
  float largest = 0;
  for (int k = 0; k < frames; ++k) {
    const inr::Image image = test.picture(static_cast<std::uint64_t>(k));
    for (std::size_t i = static_cast<std::size_t>(channel); i < image.pixels.size(); i += 4) {
      EXPECT_GE(image.pixels[i], 0.0f); // and is a number
      largest = std::max(largest, image.pixels[i]);
    }
  }
  return largest;
}

TEST(Fireflies, AreNoBrighterThanAPathCanBe)
{
  for (const double anisotropy : {-0.99, 0.0, 0.99}) {
    for (const double depth : {0.1, 2.0, 50.0}) {
      for (const int roulette : {0, 4}) {
        PathTest test({17, 17, 17}, Waves, Colours(), CellsOf(Waves, {17, 17, 17}, 8));
        SetDepth(test, 0.2, depth);
        test.options.anisotropy = anisotropy;
        test.options.scatteringAlbedo = 0.6f;
        test.options.rouletteAfter = roulette;
        test.options.maximumBounces = 12;
        test.options.ambientLight = {0.3f, 0.2f, 0};
        test.lights = {Along(1, {1, 0.5f, 0.25f}), Along(-1, {0.2f, 3, 0.25f})};
        for (int channel = 0; channel < 3; ++channel) {
          const double most = MostOfAPath(test, channel, channel == 2 ? 0.5 : 1.0);
          EXPECT_LE(LargestOf(test, channel, 4), 1.00001 * most)
              << anisotropy << " " << depth << " " << roulette << " " << channel;
        }
      }
    }
  }
}

/// Which is no idle bound: a path that is lit at each of its scatterings is as bright as that.
TEST(Fireflies, CanBeAsBrightAsTheBound)
{
  for (const int bounces : {1, 2, 3}) {
    for (const int roulette : {1, 4}) {
      PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
      SetDepth(test, 0.3f, 1.0);
      test.options.scatteringAlbedo = 0.5f;
      test.options.rouletteAfter = roulette;
      test.options.maximumBounces = bounces;
      test.lights = {Along(1)};
      const double most = MostOfAPath(test, 0, 1.0);
      const float largest = LargestOf(test, 0, 40);
      EXPECT_LE(largest, 1.00001 * most) << bounces << " " << roulette;
      EXPECT_GE(largest, 0.99999 * most) << bounces << " " << roulette;
    }
  }
}

/// Two lights, one along the view and one against it: one in two paths looks at each, and has twice
/// its light with the chance that single scattering has of being seen.
TEST(Fireflies, AreAsRareAsTheVarianceSays)
{
  for (const double anisotropy : {-0.9, 0.0, 0.9}) {
    for (const double depth : {0.01, 1.0, 4.0}) {
      PathTest test({17, 17, 17}, Constant, UniformMedium(0.3f));
      SetDepth(test, 0.3f, depth);
      test.options.anisotropy = anisotropy;
      test.options.maximumBounces = 1;
      test.options.scatteringAlbedo = 0.5f;
      test.lights = {Along(1), Along(-1)};
      const double light = 2 * 0.5 * Pi;
      const double back = light * inr::PhaseDensity(anisotropy, -1);
      const double ahead = light * inr::PhaseDensity(anisotropy, 1);
      const double seenBack = 0.5 * -0.5 * std::expm1(-2 * depth);
      const double seenAhead = 0.5 * depth * std::exp(-depth);
      const double truth = back * back * seenBack + ahead * ahead * seenAhead;
      const double fourth = std::pow(back, 4) * seenBack + std::pow(ahead, 4) * seenAhead;
      double sum = 0;
      double count = 0;
      for (std::uint64_t k = 0; k < 40; ++k) {
        const inr::Image image = test.picture(k);
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
          sum += static_cast<double>(image.pixels[i]) * image.pixels[i];
          ++count;
        }
      }
      const double error = std::sqrt((fourth - truth * truth) / count);
      EXPECT_LT(std::abs(sum / count - truth), Unlikely * error) << anisotropy << " " << depth;
      EXPECT_LT(error, 0.2 * truth) << "nothing is known";
    }
  }
}

} // namespace test::fireflies
