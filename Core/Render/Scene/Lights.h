// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstdint>

namespace inr {

enum class LightKind : std::uint8_t {
  Directional, ///< infinitely far away
  Point,
  Spot ///< a point that shines into a cone
};

/// A light of the scene in world space. As in VTK, a white Lambertian surface that faces a light of
/// intensity 1 shows the light's colour: the light gives it an irradiance of pi times that colour.
struct Light
{
  LightKind kind = LightKind::Directional;
  glm::dvec3 position{0.0};            ///< unless directional
  glm::dvec3 direction{0.0, 0.0, 1.0}; ///< into which it shines, any length; unless a point
  glm::vec3 color{1.0f};               ///< times intensity, not negative
  /// Irradiance falls as 1 / (x + y d + z d^2) over the world distance d; unless directional.
  glm::dvec3 attenuation{1.0, 0.0, 0.0};
  double coneAngle = 30; ///< of a spot, degrees from its axis to its rim, above 0 up to 90
  double exponent = 1; ///< of a spot: irradiance is in proportion to cos(angle from axis)^exponent

  bool operator==(const Light& other) const
  {
    return this->kind == other.kind && this->position == other.position &&
           this->direction == other.direction && this->color == other.color &&
           this->attenuation == other.attenuation && this->coneAngle == other.coneAngle &&
           this->exponent == other.exponent;
  }
};

/// What a point gets from a light where nothing is in between.
struct Illumination
{
  glm::dvec3 toLight{0.0}; ///< world unit vector
  double distance = 0;     ///< to the light, world; infinite for a directional one
  glm::vec3 irradiance{0}; ///< on a surface that faces the light
};

namespace detail {

constexpr double Pi = 3.14159265358979323846;

/// Part of a spot's light that goes into a direction.
INR_HOST_DEVICE inline double SpotFactor(const Light& light, const glm::dvec3& toLight)
{
  const double cosine = -glm::dot(toLight, glm::normalize(light.direction));
  const bool lit = cosine > 0 && cosine >= std::cos(light.coneAngle * (Pi / 180.0));
  return lit ? std::pow(cosine, light.exponent) : 0.0;
}

} // namespace detail

/// Irradiance is 0 at the light's own place.
INR_HOST_DEVICE inline Illumination IlluminationAt(const Light& light, const glm::dvec3& world)
{
  if (light.kind == LightKind::Directional) {
    return {-glm::normalize(light.direction), Infinite,
            light.color * static_cast<float>(detail::Pi)};
  }
  const glm::dvec3 way = light.position - world;
  const double distance = glm::length(way);
  if (!(distance > 0)) {
    return {};
  }
  const glm::dvec3 toLight = way / distance;
  const glm::dvec3& a = light.attenuation;
  double factor = detail::Pi / (a.x + distance * (a.y + distance * a.z));
  if (light.kind == LightKind::Spot) {
    factor *= detail::SpotFactor(light, toLight);
  }
  return {toLight, distance, light.color * static_cast<float>(factor)};
}

} // namespace inr
