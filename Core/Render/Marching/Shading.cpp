// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/Shading.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace inr {

namespace {

bool IsDirectional(const Light& light) { return light.kind == LightKind::Directional; }

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
  if (!this->View.knowsPlaces() && !this->View.hasHighlights()) {
    this->Diffuse = this->takeDiffuse();
  }
}

DiffuseLights Shading::takeDiffuse()
{
  const Material& surface = this->View.surface;
  for (const Illumination& light : this->Constant) {
    const glm::vec3 direction(light.toLight);
    const glm::vec3 rgb = light.irradiance * static_cast<float>(1.0 / detail::Pi) * surface.diffuse;
    this->DiffuseEach.push_back({{direction.x, direction.y, direction.z}, {rgb.r, rgb.g, rgb.b}});
  }
  DiffuseLights all{
      this->DiffuseEach.data(), static_cast<int>(this->DiffuseEach.size()), surface.ambient, {}};
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
