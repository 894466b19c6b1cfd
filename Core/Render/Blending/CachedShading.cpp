// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Blending/CachedShading.h"

#include <utility>

namespace inr {

CachedShading::CachedShading(MarchedBatch& batch, std::unique_ptr<CachedColors> colors)
    : Shader(*batch.scene().shading,
             BrickGradients(*batch.scene().bricks, batch.scene().format, batch.scene().kernel),
             batch.scene().kernel),
      Batch(batch), Scene(batch.scene()), Colors(std::move(colors))
{}

void CachedShading::advance(CachedRay& ray)
{
  const SampleWalker before = ray.samples; // bricks may be asked for that are not there
  const KnownValue knownBefore = ray.known;
  this->Batch.fill(ray);
  this->Batch.clampToRanges();
  glm::vec4 colors[SampleBatch::Capacity];
  float opacities[SampleBatch::Capacity];
  const int found = this->Colors->find(ray, colors, opacities);
  const int lit = this->shade(ray, found, colors);
  for (int k = 0; k < lit; ++k) {
    if (opacities[k] > 0.0f && ray.addLight(colors[k], opacities[k])) {
      ray.halfOpaqueAt = this->Batch.timeOf(ray, k);
    }
  }
  this->Colors->goOnBehind(lit, knownBefore, ray); // no further than what is lit
  if (lit < this->Batch.placed().count && ray.color.transmittance > OpaqueTransmittance) {
    this->Batch.goBackTo(lit, before, ray);
  }
}

int CachedShading::shade(const CachedRay& ray, int count, glm::vec4* colors)
{
  const bool isLitFromPlaces = this->Scene.shading->view().knowsPlaces();
  double t[SampleBatch::Capacity];
  for (int k = 0; isLitFromPlaces && k < count; ++k) {
    t[k] = this->Batch.timeOf(ray, k);
  }
  const bool stops = this->Batch.missing() == OnMiss::Stop;
  const SampleShader::Request request{
      ray.ray, stops ? BrickGradients::Missing::Stop : BrickGradients::Missing::OneSided,
      static_cast<float>(ray.color.transmittance), this->Batch.placed().bricks,
      isLitFromPlaces ? t : nullptr};
  const std::size_t asked = this->Batch.requests().entries().size();
  const int known =
      this->Shader.shade(this->Batch.samples(), count, request, this->Batch.requests(), colors);
  if (!stops) {
    this->Batch.statistics().missed +=
        static_cast<std::int64_t>(this->Batch.requests().entries().size() - asked);
  }
  return known;
}

} // namespace inr
