// SPDX-License-Identifier: BSD-3-Clause
//
// Single scattering from every kind of light against quadrature, and the phase function by itself.
#include "Testing/Core/Render/PathScene.h"

namespace test::path_tracing_lights {

constexpr double Pi = 3.14159265358979323846;

double HenyeyGreenstein(double g, double cosine)
{
  return (1 - g * g) / (4 * Pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
}

/// World points 0 ... Corner are the visible domain of the lit scenes: 17 points per axis.
const glm::dvec3 Spacing(1.0, 0.5, 2.0);
const glm::dvec3 Corner = 16.0 * Spacing;
const glm::dvec2 Pixel(5.0, 3.0); ///< all pixels look along +z at this x and y
constexpr double Density = 0.08;  ///< extinction per world length
constexpr double Anisotropy = 0.4;

/// What reaches a point if nothing is in between: way to the light, how far it is, irradiance.
struct Arrival
{
  glm::dvec3 toLight;
  double distance;
  double irradiance;
};
using Source = std::function<Arrival(const glm::dvec3& world)>;

double WayOut(const glm::dvec3& from, const glm::dvec3& direction)
{
  double way = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    const double face = direction[axis] > 0 ? Corner[axis] : 0.0;
    way = direction[axis] != 0 ? std::min(way, (face - from[axis]) / direction[axis]) : way;
  }
  return way;
}

double SinglyScattered(const Source& source)
{
  constexpr int steps = 200000; // midpoint rule
  const double step = Corner.z / steps;
  double sum = 0;
  for (int k = 0; k < steps; ++k) {
    const glm::dvec3 world(Pixel, (k + 0.5) * step);
    const Arrival arrival = source(world);
    const double way = std::min(WayOut(world, arrival.toLight), arrival.distance);
    sum += std::exp(-Density * (world.z + way)) * arrival.irradiance *
           HenyeyGreenstein(Anisotropy, arrival.toLight.z);
  }
  return sum * step * Density;
}

/// Albedo is 0.8 * (1, 0.5, 0.25).
void ExpectSingleScattering(const inr::Light& light, const Source& source, bool withAnother = false)
{
  const auto opacity = static_cast<float>(1.0 - std::exp(-Density * 1.5));
  PathTest test({17, 17, 17}, Constant, UniformMedium(opacity, {1.0f, 0.5f, 0.25f}));
  test.frame = ParallelFrame(32, Pixel - 1e-7, Pixel + 1e-7, -10, 50);
  test.frame.worldToIndex = glm::scale(glm::dmat4(1.0), 1.0 / Spacing);
  test.frame.unitDistance = 1.5;
  test.options.maximumBounces = 1;
  test.options.scatteringAlbedo = 0.8f;
  test.options.anisotropy = Anisotropy;
  test.lights.assign(withAnother ? 2 : 1, light);
  const double truth = SinglyScattered(source) * (withAnother ? 2 : 1);
  const Estimate red = test.estimate(0, 60);
  const Estimate blue = test.estimate(2, 60);
  EXPECT_LT(std::abs(red.z(0.8 * truth)), Unlikely) << red.mean << " " << 0.8 * truth;
  EXPECT_LT(std::abs(blue.z(0.2 * truth)), Unlikely);
  EXPECT_LT(red.error, 0.01 * red.mean); // so that a mistake would show
}

TEST(PathTracingLights, DirectionalMatchesQuadrature)
{
  inr::Light light;
  light.direction = {1.0, -2.0, 0.5};
  light.color = glm::vec3(2.0f);
  const glm::dvec3 toLight = -glm::normalize(light.direction);
  const Source source = [toLight](const glm::dvec3&) { return Arrival{toLight, 1e9, 2 * Pi}; };
  ExpectSingleScattering(light, source);
  ExpectSingleScattering(light, source, true);
}

TEST(PathTracingLights, PointMatchesQuadratureInsideAndOutside)
{
  for (const glm::dvec3& position : {glm::dvec3(10, 6, 12), glm::dvec3(-7, 20, 30)}) {
    inr::Light light;
    light.kind = inr::LightKind::Point;
    light.position = position;
    light.color = glm::vec3(3.0f);
    light.attenuation = {0.5, 0.1, 0.02};
    ExpectSingleScattering(light, [position](const glm::dvec3& world) {
      const double d = glm::distance(position, world);
      return Arrival{(position - world) / d, d, 3 * Pi / (0.5 + 0.1 * d + 0.02 * d * d)};
    });
  }
}

TEST(PathTracingLights, SpotMatchesQuadrature)
{
  inr::Light light;
  light.kind = inr::LightKind::Spot;
  light.position = {12, 3.5, -2};
  light.direction = {-1, 0, 2};
  light.coneAngle = 20;
  light.exponent = 3;
  ExpectSingleScattering(light, [&light](const glm::dvec3& world) {
    const glm::dvec3 way = light.position - world;
    const double cosine = glm::dot(-way, light.direction) / glm::length(way) / std::sqrt(5.0);
    const bool lit = std::acos(cosine) <= 20 * Pi / 180;
    return Arrival{glm::normalize(way), glm::length(way),
                   lit ? Pi * cosine * cosine * cosine : 0.0};
  });
}

TEST(PathTracingLights, PhaseFunctionIsNormalisedWithItsMean)
{
  constexpr int steps = 400000;
  for (const double g : {-0.9, -0.3, 0.0, 5e-5, 2e-4, 0.5, 0.95}) {
    double total = 0;
    double mean = 0;
    double sampled = 0;
    for (int k = 0; k < steps; ++k) {
      const double share = (k + 0.5) / steps;
      const double cosine = 2 * share - 1;
      const double density = inr::PhaseDensity(g, cosine) * 4 * Pi / steps;
      total += density;
      mean += density * cosine;
      sampled += inr::SamplePhaseCosine(g, share) / steps;
    }
    EXPECT_NEAR(total, 1.0, 1e-6) << g;
    EXPECT_NEAR(mean, g, 1e-6) << g;
    EXPECT_NEAR(sampled, g, 1e-6) << g;
  }
}

TEST(PathTracingLights, PhaseSamplesAreTheDensitysQuantiles)
{
  for (const double g : {-0.7, 0.0, 5e-5, 0.3, 0.9}) {
    constexpr int steps = 100000;
    for (const double share : {0.0, 0.1, 0.5, 0.93}) {
      const double cosine = inr::SamplePhaseCosine(g, share);
      double below = 0;
      for (int k = 0; k < steps; ++k) {
        const double at = -1 + (cosine + 1) * (k + 0.5) / steps;
        below += inr::PhaseDensity(g, at) * 2 * Pi * (cosine + 1) / steps;
      }
      EXPECT_NEAR(below, share, 1e-6) << g;
    }
  }
}

TEST(PathTracingLights, TurnsAreAboutTheDirection)
{
  for (const glm::dvec3& raw : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(1, 2, -3)}) {
    const glm::dvec3 direction = glm::normalize(raw);
    glm::dvec3 sum(0.0);
    for (int k = 0; k < 8; ++k) {
      const glm::dvec3 turned = inr::Turn(direction, 0.3, k / 8.0);
      EXPECT_NEAR(glm::dot(turned, direction), 0.3, 1e-12);
      EXPECT_NEAR(glm::length(turned), 1.0, 1e-12);
      sum += turned;
    }
    EXPECT_LT(glm::distance(sum, direction * 2.4), 1e-12); // all the way round
  }
}

TEST(PathTracingLights, AnglesAreThoseOfTheLibrary)
{
  for (int k = 0; k < 1000; ++k) {
    const double turn = k / 1000.0;
    const inr::SineCosine angle = inr::OfTurn(turn);
    EXPECT_NEAR(angle.sine, std::sin(2 * Pi * turn), 1e-13) << turn;
    EXPECT_NEAR(angle.cosine, std::cos(2 * Pi * turn), 1e-13) << turn;
  }
}

TEST(PathTracingLights, AnyDirectionIsAsLikelyAsAnother)
{
  constexpr int steps = 200;
  glm::dvec3 mean(0.0);
  glm::dmat3 squares(0.0);
  for (int k = 0; k < steps * steps; ++k) {
    const double u = (k / steps + 0.5) / steps;
    const glm::dvec3 way = inr::AnyDirection(u, (k % steps + 0.5) / steps);
    EXPECT_NEAR(glm::length(way), 1.0, 1e-12);
    mean += way / static_cast<double>(steps * steps);
    squares += glm::outerProduct(way, way) / static_cast<double>(steps * steps);
  }
  EXPECT_LT(glm::length(mean), 1e-9);
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 third(0.0);
    third[axis] = 1.0 / 3; // the sphere's
    EXPECT_LT(glm::length(squares[axis] - third), 1e-4);
  }
}

} // namespace test::path_tracing_lights
