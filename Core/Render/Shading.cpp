// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Shading.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

bool IsDirectional(const Light& light) { return light.kind == LightKind::Directional; }

} // namespace

Shading::Shading(const Frame& frame)
    : Surface(*frame.shading), Lights(frame.lights), ToWorld(glm::inverse(frame.worldToIndex)),
      GradientToWorld(glm::transpose(glm::dmat3(frame.worldToIndex)))
{
  std::stable_partition(this->Lights.begin(), this->Lights.end(), IsDirectional);
  for (const Light& light : this->Lights) {
    if (IsDirectional(light)) {
      this->Constant.push_back(IlluminationAt(light, glm::dvec3(0.0)));
    }
  }
}

Shading::View Shading::viewAlong(const Ray& ray) const
{
  return {-glm::normalize(glm::dmat3(this->ToWorld) * ray.direction)};
}

glm::vec3 Shading::shade(const glm::vec3& color, const View& view, const glm::dvec3& index,
                         const glm::vec3& gradient) const
{
  glm::vec3 result = color * this->Surface.ambient;
  const glm::dvec3 across = this->GradientToWorld * glm::dvec3(gradient);
  const double steepness = glm::length(across);
  if (!(steepness > 0)) {
    return result;
  }
  const glm::dvec3 normal = across / steepness;
  const glm::dvec3 world(this->ToWorld * glm::dvec4(index, 1.0));
  for (std::size_t k = 0; k < this->Lights.size(); ++k) {
    const Illumination light =
        k < this->Constant.size() ? this->Constant[k] : IlluminationAt(this->Lights[k], world);
    const double facing = glm::dot(normal, light.toLight);
    const double mirrored =
        2.0 * facing * glm::dot(normal, view.toEye) - glm::dot(light.toLight, view.toEye);
    const float diffuse = static_cast<float>(std::abs(facing)) * this->Surface.diffuse;
    const float specular =
        mirrored > 0 ? std::pow(static_cast<float>(mirrored), this->Surface.specularPower) *
                           this->Surface.specular
                     : 0.0f;
    // An irradiance of pi makes a white surface white.
    result += light.irradiance * static_cast<float>(1.0 / detail::Pi) *
              (color * diffuse + glm::vec3(specular));
  }
  return result;
}

} // namespace inr
