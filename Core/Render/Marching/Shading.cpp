// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/Shading.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace inr {

namespace {

bool IsDirectional(const Light& light) { return light.kind == LightKind::Directional; }

bool HasHighlights(const Material& surface) { return surface.specular > 0.0f; }

bool HasWholePower(const Material& surface)
{
  constexpr float most = 128; // VTK's
  return surface.specularPower == std::floor(surface.specularPower) &&
         surface.specularPower <= most;
}

double LargestElement(const glm::dmat3& matrix)
{
  double largest = 0;
  for (int column = 0; column < 3; ++column) {
    const glm::dvec3 sizes = glm::abs(matrix[column]);
    largest = std::max({largest, sizes.x, sizes.y, sizes.z});
  }
  return largest;
}

} // namespace

Shading::Shading(const Frame& frame) : Lights(frame.lights)
{
  std::stable_partition(this->Lights.begin(), this->Lights.end(), IsDirectional);
  for (const Light& light : this->Lights) {
    if (IsDirectional(light)) {
      this->Constant.push_back(IlluminationAt(light, glm::dvec3(0.0)));
    }
  }
  this->View.surface = *frame.shading;
  this->View.lights = this->Lights.data();
  this->View.lightCount = static_cast<int>(this->Lights.size());
  this->View.constant = this->Constant.data();
  this->View.constantCount = static_cast<int>(this->Constant.size());
  this->View.toWorld = glm::inverse(frame.worldToIndex);
  this->View.gradientToWorld = glm::transpose(glm::dmat3(frame.worldToIndex));
  const Material& surface = this->View.surface;
  if (!this->View.knowsPlaces() && (!HasHighlights(surface) || HasWholePower(surface))) {
    this->Directional = this->takeDirectional();
  }
}

DirectionalLights Shading::takeDirectional()
{
  const Material& surface = this->View.surface;
  for (const Illumination& light : this->Constant) {
    const glm::vec3 direction(light.toLight);
    const glm::vec3 rgb = light.irradiance * static_cast<float>(1.0 / detail::Pi);
    this->DirectionalEach.push_back(
        {{direction.x, direction.y, direction.z}, {rgb.r, rgb.g, rgb.b}});
  }
  DirectionalLights all{};
  all.lights = this->DirectionalEach.data();
  all.count = static_cast<int>(this->DirectionalEach.size());
  all.ambient = surface.ambient;
  all.diffuse = surface.diffuse;
  all.specular = surface.specular;
  if (HasHighlights(surface)) {
    all.specularPower = static_cast<int>(surface.specularPower);
    all.leastMirrored = std::exp2(-100.0f / std::max(surface.specularPower, 1.0f));
  }
  const glm::dmat3& toWorld = this->View.gradientToWorld;
  const double largest = LargestElement(toWorld);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      all.gradientToWorld[row][column] = static_cast<float>(toWorld[column][row] / largest);
    }
  }
  return all;
}

} // namespace inr
