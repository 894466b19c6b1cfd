// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Bricks/BrickGradients.h"
#include "Core/Render/Marching/Shading.h"

#include <glm/vec4.hpp>

namespace inr {

/// Lights samples from the cache by the scene's lights. Only what can be seen gets a
/// gradient.
class SampleShader
{
public:
  SampleShader(const Shading& shading, const BrickGradients& gradients, const BrickKernel& kernel)
      : Lighting(shading), Kernel(kernel), Gradients(gradients)
  {}

  /// How a ray's samples are looked at.
  struct Request
  {
    const Ray& ray;
    BrickGradients::Missing missing;
    float transmittance;    ///< of the ray so far
    const BrickKey* bricks; ///< of the batch's paths
    const double* t;        ///< of the samples; null unless ShadingView::knowsPlaces()
  };

  /// Lights `colors`, straight RGB and opacity of the first `count` samples of
  /// `batch`. Returns for how many of them that was possible: fewer only with Missing::Stop.
  int shade(const SampleBatch& batch, int count, const Request& request, RequestList& requests,
            glm::vec4* colors);

  std::int64_t gradients() const { return this->Gradients.found(); } ///< so far

private:
  /// Those which[0 .. count) of the colours, whose gradients were found.
  void shadeAll(const int* which, int count, const Request& request, glm::vec4* colors);
  /// The same one after another, by any lights.
  void shadeEach(const int* which, int count, const Request& request, glm::vec4* colors) const;

  const Shading& Lighting;
  const BrickKernel& Kernel;
  BrickGradients Gradients;
  LightBatch Light{};
};

} // namespace inr
