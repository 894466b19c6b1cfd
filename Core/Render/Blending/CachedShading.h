// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Blending/CachedBlending.h"
#include "Core/Render/Bricks/SampleShader.h"

#include <memory>

namespace inr {

/// Samples lit by the scene's lights, composited.
class CachedShading : public CachedBlending
{
public:
  /// Lights those `colors`. The batch, which they are of, must outlive it.
  CachedShading(MarchedBatch& batch, std::unique_ptr<CachedColors> colors);

  void begin() override { this->Colors->begin(); }
  void advance(CachedRay& ray) override;
  std::int64_t gradients() const override { return this->Shader.gradients(); }

private:
  /// Lights the first `count` samples; for how many of them that was possible.
  int shade(const CachedRay& ray, int count, glm::vec4* colors);

  SampleShader Shader; // before what is smaller: it has a batch, which begins at a cache line
  MarchedBatch& Batch;
  const CachedScene& Scene;
  std::unique_ptr<CachedColors> Colors;
};

} // namespace inr
