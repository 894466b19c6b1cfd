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
  glm::vec3 gradients[SampleBatch::Capacity];
  const int found =
      std::min(seen, this->Gradients.find(batch, request.bricks, visible, seen, request.missing,
                                          request.transmittance, requests, gradients));
  const ShadingView& lighting = this->Lighting.view();
  const glm::dvec3 toEye = lighting.toEye(request.ray);
  for (int k = 0; k < found; ++k) {
    glm::vec4& color = colors[visible[k]];
    const glm::dvec3 index =
        request.t != nullptr ? request.ray.at(request.t[visible[k]]) : glm::dvec3(0.0);
    const glm::vec3 lit = lighting.shade(glm::vec3(color), toEye, index, gradients[k]);
    color = glm::vec4(lit, color.w);
  }
  return found < seen ? visible[found] : count;
}

} // namespace inr
