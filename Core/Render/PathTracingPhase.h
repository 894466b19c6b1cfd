// SPDX-License-Identifier: BSD-3-Clause
//
// The phase function of Henyey and Greenstein ("Diffuse radiation in the galaxy", Astrophysical
// Journal 93, 1941).
#pragma once

#include "Core/HostDevice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>

namespace inr {

/// Density per steradian of turning by an angle with this cosine; g in (-1, 1) is its mean cosine.
INR_HOST_DEVICE inline double PhaseDensity(double g, double cosine)
{
  constexpr double inverseSphere = 0.07957747154594767; // 1 / (4 pi)
  const double base = 1.0 + g * g - 2.0 * g * cosine;
  return inverseSphere * (1.0 - g * g) / (base * std::sqrt(base));
}

/// The cosine below which a share `u` in [0, 1) of all turns lies.
INR_HOST_DEVICE inline double SamplePhaseCosine(double g, double u)
{
  constexpr double isotropic = 1e-4; // the inversion divides by g
  if (std::abs(g) < isotropic) {
    // First order in g, whose density is (1 + 3 g cos) / 2: exact enough to stay below 1e-8.
    const double even = 2.0 * u - 1.0;
    return even + 1.5 * g * (1.0 - even * even);
  }
  const double root = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
  return glm::clamp((1.0 + g * g - root * root) / (2.0 * g), -1.0, 1.0);
}

/// `direction` (a unit vector) turned by the angle of `cosine` and, about itself, by a share `turn`
/// in [0, 1) of a whole turn.
INR_HOST_DEVICE inline glm::dvec3 Turn(const glm::dvec3& direction, double cosine, double turn)
{
  const glm::dvec3 aside = std::abs(direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(direction, aside));
  const glm::dvec3 second = glm::cross(direction, first);
  const double angle = 6.283185307179586 * turn;
  const double sine = std::sqrt(glm::max(0.0, 1.0 - cosine * cosine));
  return glm::normalize(cosine * direction +
                        sine * (std::cos(angle) * first + std::sin(angle) * second));
}

} // namespace inr
