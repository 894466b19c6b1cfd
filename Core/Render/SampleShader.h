// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/BrickGradients.h"
#include "Core/Render/ColorTable.h"
#include "Core/Render/Shading.h"

#include <glm/vec4.hpp>

namespace inr {

/// Colours of samples from the cache, lit by the scene's lights. Only what can be seen gets a
/// gradient.
class SampleShader
{
public:
  SampleShader(const Shading& shading, const ColorLookup& colors, BrickGradients gradients)
      : Lighting(shading), Colors(colors), Gradients(gradients)
  {}

  /// How a ray's samples are looked at.
  struct Request
  {
    const Ray& ray;
    BrickGradients::Missing missing;
    float transmittance;    ///< of the ray so far
    const BrickKey* bricks; ///< of the batch's paths
    const double* t;        ///< of the samples
  };

  /// Straight RGB and opacity per unit distance of the first `count` samples of `batch`, whose
  /// values have been found and moved into their ranges. Returns for how many of them it is known:
  /// fewer only with Missing::Stop.
  int shade(const SampleBatch& batch, int count, const Request& request, RequestList& requests,
            glm::vec4* colors);

  std::int64_t gradients() const { return this->Gradients.found(); } ///< so far

private:
  const Shading& Lighting;
  const ColorLookup& Colors;
  BrickGradients Gradients;
};

} // namespace inr
