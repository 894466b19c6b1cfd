// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Marching/Shading.h"

#include <glm/matrix.hpp>

#include <algorithm>

namespace inr {

namespace {

bool IsDirectional(const Light& light) { return light.kind == LightKind::Directional; }

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
}

} // namespace inr
