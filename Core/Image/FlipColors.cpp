// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Image/FlipColors.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace inr {

namespace {

/// Linear sRGB to CIE XYZ, from the primaries of IEC 61966-2-1 and its white of x 0.3127, y 0.3290.
const glm::dmat3 RgbToXyz(0.4123907992659595, 0.2126390058715104, 0.0193308187155918,  // of red,
                          0.3575843393838780, 0.7151686787677559, 0.1191947797946259,  // green
                          0.1804807884018343, 0.0721923153607337, 0.9505321522496608); // and blue
const glm::dmat3 XyzToRgb = glm::inverse(RgbToXyz);
const glm::dvec3 White = RgbToXyz * glm::dvec3(1.0);

/// XYZ in units of white.
glm::dvec3 RelativeXyz(const glm::dvec3& linear) { return RgbToXyz * linear / White; }

} // namespace

glm::dvec3 LinearOf(const glm::dvec3& display)
{
  const auto linear = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return {linear(display.x), linear(display.y), linear(display.z)};
}

glm::dvec3 OpponentOf(const glm::dvec3& linear)
{
  const glm::dvec3 xyz = RelativeXyz(linear);
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

glm::dvec3 LinearOfOpponent(const glm::dvec3& opponent)
{
  const double y = (opponent.x + 16) / 116;
  const glm::dvec3 xyz(y + opponent.y / 500, y, y - opponent.z / 200);
  return XyzToRgb * (xyz * White);
}

glm::dvec3 PerceivedColor(const glm::dvec3& linear)
{
  constexpr double delta = 6.0 / 29;
  const auto root = [](double t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const glm::dvec3 xyz = RelativeXyz(linear);
  const double lightness = 116 * root(xyz.y) - 16;
  const double hunt = 0.01 * lightness;
  return {lightness, hunt * 500 * (root(xyz.x) - root(xyz.y)),
          hunt * 200 * (root(xyz.y) - root(xyz.z))};
}

double ColorDistance(const glm::dvec3& a, const glm::dvec3& b)
{
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

} // namespace inr
