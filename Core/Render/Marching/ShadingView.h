// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Rays/Ray.h"
#include "Core/Render/Scene/Lights.h"
#include "Core/Render/Scene/Material.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <cmath>

namespace inr {

/// A Shading, which says what it computes, as plain data, whose arrays lie in the memory of whoever
/// reads it.
struct ShadingView
{
  Material surface;
  const Light* lights = nullptr; ///< the directional ones first
  int lightCount = 0;
  const Illumination* constant = nullptr; ///< of the directional ones
  int constantCount = 0;
  glm::dmat4 toWorld{1.0};
  glm::dmat3 gradientToWorld{1.0};

  /// World unit vector along a ray to the eye.
  INR_HOST_DEVICE glm::dvec3 toEye(const Ray& ray) const
  {
    return -glm::normalize(glm::dmat3(this->toWorld) * ray.direction);
  }

  /// Whether it matters where a sample is.
  INR_HOST_DEVICE bool knowsPlaces() const { return this->lightCount > this->constantCount; }

  /// See Shading.
  INR_HOST_DEVICE glm::vec3 shade(const glm::vec3& color, const glm::dvec3& toEye,
                                  const glm::dvec3& index, const glm::vec3& gradient) const
  {
    glm::vec3 result = color * this->surface.ambient;
    const glm::dvec3 across = this->gradientToWorld * glm::dvec3(gradient);
    const double steepness = glm::length(across);
    if (!(steepness > 0 && steepness < Infinite)) { // values next to a float's largest
      return result;
    }
    const glm::dvec3 normal = across * (1.0 / steepness);
    for (int k = 0; k < this->constantCount; ++k) {
      result += this->lit(color, toEye, normal, this->constant[k]);
    }
    if (this->knowsPlaces()) {
      const glm::dvec3 world(this->toWorld * glm::dvec4(index, 1.0));
      for (int k = this->constantCount; k < this->lightCount; ++k) {
        result += this->lit(color, toEye, normal, IlluminationAt(this->lights[k], world));
      }
    }
    return result;
  }

private:
  INR_HOST_DEVICE glm::vec3 lit(const glm::vec3& color, const glm::dvec3& toEye,
                                const glm::dvec3& normal, const Illumination& light) const
  {
    const double facing = glm::dot(normal, light.toLight);
    const float diffuse = static_cast<float>(std::abs(facing)) * this->surface.diffuse;
    // An irradiance of pi makes a white surface white.
    return light.irradiance * static_cast<float>(1.0 / detail::Pi) *
           (color * diffuse + glm::vec3(this->highlight(facing, toEye, normal, light.toLight)));
  }

  /// None by ParaView's defaults, and a power is a good part of what a lit sample takes.
  INR_HOST_DEVICE float highlight(double facing, const glm::dvec3& toEye, const glm::dvec3& normal,
                                  const glm::dvec3& toLight) const
  {
    if (!(this->surface.specular > 0.0f)) {
      return 0.0f;
    }
    const double mirrored = 2.0 * facing * glm::dot(normal, toEye) - glm::dot(toLight, toEye);
    return mirrored > 0 ? std::pow(static_cast<float>(mirrored), this->surface.specularPower) *
                              this->surface.specular
                        : 0.0f;
  }
};

} // namespace inr
