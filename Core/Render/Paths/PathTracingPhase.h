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
  if (g == 0) {
    return inverseSphere;
  }
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

struct SineCosine
{
  double sine;
  double cosine;
};

/// Of a share `turn` in [0, 1) of a whole turn, to 1e-13: the library's take any angle, and their
/// time.
INR_HOST_DEVICE inline SineCosine OfTurn(double turn)
{
  // The nearest, 0 to 4; lround takes its time.
  const int quarter = static_cast<int>(4.0 * turn + 0.5); // NOLINT(bugprone-incorrect-roundings)
  const double x = (4.0 * turn - quarter) * 1.5707963267948966; // within pi / 4
  const double y = x * x;
  // Taylor's series.
  const double inner = 1.0 / 362880 + y * (-1.0 / 39916800 + y * (1.0 / 6227020800));
  const double sine = x * (1.0 + y * (-1.0 / 6 + y * (1.0 / 120 + y * (-1.0 / 5040 + y * inner))));
  const double outer =
      1.0 / 40320 + y * (-1.0 / 3628800 + y * (1.0 / 479001600 + y * (-1.0 / 87178291200)));
  const double cosine = 1.0 + y * (-0.5 + y * (1.0 / 24 + y * (-1.0 / 720 + y * outer)));
  const bool odd = (quarter & 1) != 0;
  const double s = odd ? cosine : sine;
  const double c = odd ? sine : cosine;
  return {(quarter & 2) != 0 ? -s : s, ((quarter + 1) & 2) != 0 ? -c : c};
}

/// A unit vector of which all are as likely, from two numbers in [0, 1).
INR_HOST_DEVICE inline glm::dvec3 AnyDirection(double u, double turn)
{
  const double z = 1.0 - 2.0 * u;
  const double radius = std::sqrt(glm::max(0.0, 1.0 - z * z));
  const SineCosine angle = OfTurn(turn);
  return {radius * angle.cosine, radius * angle.sine, z};
}

/// `direction` (a unit vector) turned by the angle of `cosine` and, about itself, by a share `turn`
/// in [0, 1) of a whole turn.
INR_HOST_DEVICE inline glm::dvec3 Turn(const glm::dvec3& direction, double cosine, double turn)
{
  // Axes across it without a root or a branch: Duff et al., "Building an orthonormal basis,
  // revisited", Journal of Computer Graphics Techniques 6(1), 2017.
  const glm::dvec3& d = direction;
  const double sign = std::copysign(1.0, d.z);
  const double a = -1.0 / (sign + d.z);
  const double b = d.x * d.y * a;
  const glm::dvec3 first(1.0 + sign * d.x * d.x * a, sign * b, -sign * d.x);
  const glm::dvec3 second(b, sign + d.y * d.y * a, -d.y);
  const SineCosine angle = OfTurn(turn);
  const double sine = std::sqrt(glm::max(0.0, 1.0 - cosine * cosine));
  const glm::dvec3 turned = cosine * d + sine * (angle.cosine * first + angle.sine * second);
  // One step of Newton's towards length 1: rounding must not add up over many turns.
  return turned * (1.5 - 0.5 * glm::dot(turned, turned));
}

} // namespace inr
