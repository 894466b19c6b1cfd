// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Bricks/SampleShader.h"

#include <algorithm>

namespace inr {

int SampleShader::shade(const SampleBatch& batch, int count, const Request& request,
                        RequestList& requests, glm::vec4* colors)
{
  int visible[SampleBatch::Capacity];
  int seen = 0;
  for (int k = 0; k < count; ++k) {
    if (colors[k].w > 0.0f) {
      visible[seen++] = k;
    }
  }
  if (seen == 0) {
    return count;
  }
  const int found =
      std::min(seen, this->Gradients.find(batch, request.bricks, visible, seen, request.missing,
                                          request.transmittance, requests));
  if (this->Lighting.directional() != nullptr) {
    this->shadeAll(visible, found, request, colors);
  } else {
    this->shadeEach(visible, found, request, colors);
  }
  return found < seen ? visible[found] : count;
}

void SampleShader::shadeAll(const int* which, int count, const Request& request, glm::vec4* colors)
{
  const glm::vec3 direction(this->Lighting.view().toEye(request.ray));
  const float toEye[3] = {direction.x, direction.y, direction.z};
  this->Kernel.light(*this->Lighting.directional(), toEye, this->Gradients.latest(), count,
                     this->Light);
  for (int k = 0; k < count; ++k) {
    glm::vec4& color = colors[which[k]];
    for (int channel = 0; channel < 3; ++channel) {
      color[channel] =
          color[channel] * this->Light.factor[channel][k] + this->Light.added[channel][k];
    }
  }
}

void SampleShader::shadeEach(const int* which, int count, const Request& request,
                             glm::vec4* colors) const
{
  const ShadingView& lighting = this->Lighting.view();
  const glm::dvec3 toEye = lighting.toEye(request.ray);
  for (int k = 0; k < count; ++k) {
    glm::vec4& color = colors[which[k]];
    const glm::dvec3 index =
        request.t != nullptr ? request.ray.at(request.t[which[k]]) : glm::dvec3(0.0);
    const glm::vec3 lit = lighting.shade(glm::vec3(color), toEye, index, this->Gradients.latest(k));
    color = glm::vec4(lit, color.w);
  }
}

} // namespace inr
