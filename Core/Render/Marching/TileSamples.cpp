// SPDX-License-Identifier: BSD-3-Clause
//
// What TileMarcher infers beside the values of a round's samples: those before them, where both
// ends of what they stand for are looked at, and gradients, where they are lit.
#include "Core/Render/Marching/PreIntegratedColors.h"
#include "Core/Render/Marching/TileMarcher.h"

namespace inr {

/// Where the steps of a sample begin the value is that of the sample before, or not known yet.
void TileMarcher::inferBegins()
{
  this->Positions.clear();
  std::vector<std::size_t> unknown;
  std::size_t k = 0;
  this->Begins.assign(this->Samples.size(), 0.0f);
  for (std::size_t live = 0; live < this->Live.size(); ++live) {
    MarchState& state = this->Rays[static_cast<std::size_t>(this->Live[live])];
    for (; k < static_cast<std::size_t>(this->SampleEnds[live]); ++k) {
      const MarchSample& sample = this->Samples[k];
      if (sample.begin < 0) { // nothing is in front of it
        this->Begins[k] = this->Values[k];
      } else if (state.knownAt == sample.begin) {
        this->Begins[k] = state.known;
      } else {
        unknown.push_back(k);
        this->Positions.push_back(FieldPosition(this->Scene.settings, state.ray.at(sample.begin)));
      }
      state.knownAt = sample.end;
      state.known = this->Values[k];
    }
  }
  std::vector<float> values(unknown.size());
  const auto count = static_cast<std::int64_t>(unknown.size());
  this->Scene.evaluator.evaluate(this->Positions.data(), count, values.data());
  this->Statistics.samples += count;
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    this->Begins[unknown[i]] = values[i];
  }
}

glm::vec4 TileMarcher::sampleColor(std::size_t sample) const
{
  const PreIntegratedLookup* const preIntegrated = this->Scene.settings.preIntegrated;
  if (preIntegrated == nullptr) {
    return this->Scene.colors.at(this->Values[sample]);
  }
  return this->Samples[sample].begin < 0
             ? glm::vec4(0.0f) // in front of the ray
             : preIntegrated->between(this->Begins[sample], this->Values[sample]);
}

/// The samples of which something is seen; those behind which a ray is opaque are the last.
void TileMarcher::listVisible()
{
  this->Lit.resize(this->Samples.size());
  this->Visible.clear();
  std::size_t k = 0;
  for (std::size_t live = 0; live < this->Live.size(); ++live) {
    double opacity = this->Rays[static_cast<std::size_t>(this->Live[live])].color.w;
    for (; k < static_cast<std::size_t>(this->SampleEnds[live]); ++k) {
      this->Lit[k] = this->sampleColor(k);
      if (this->Lit[k].w > 0.0f && opacity < OpaqueEnough) {
        this->Visible.push_back(k);
        opacity += (1.0 - opacity) * OpacityOver(this->Samples[k].length, this->Lit[k].w);
      }
    }
  }
}

void TileMarcher::inferGradients()
{
  const glm::vec3 voxel(1.0 / this->Scene.settings.dims);
  const glm::vec3 low = 0.5f * voxel;
  this->listVisible();
  this->Positions.clear();
  for (const std::size_t k : this->Visible) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0f, 1.0f}) {
        glm::vec3 position = this->Samples[k].position;
        position[axis] =
            glm::clamp(position[axis] + side * voxel[axis], low[axis], 1.0f - low[axis]);
        this->Positions.push_back(position);
      }
    }
  }
  const auto count = static_cast<std::int64_t>(this->Positions.size());
  this->Neighbors.resize(this->Positions.size());
  this->Scene.evaluator.evaluate(this->Positions.data(), count, this->Neighbors.data());
  this->Statistics.samples += count;
  this->Statistics.work.gradients += static_cast<std::int64_t>(this->Visible.size());
}

void TileMarcher::shade()
{
  const ShadingView& lighting = this->Scene.shading->view();
  const glm::vec3 dims(this->Scene.settings.dims);
  std::size_t live = 0;
  for (std::size_t k = 0; k < this->Visible.size(); ++k) {
    glm::vec3 gradient(0.0f);
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t lower = 6 * k + 2 * static_cast<std::size_t>(axis);
      const float length =
          (this->Positions[lower + 1][axis] - this->Positions[lower][axis]) * dims[axis];
      const float difference = this->Neighbors[lower + 1] - this->Neighbors[lower];
      gradient[axis] = length > 0.0f ? difference / length : 0.0f;
    }
    const std::size_t sample = this->Visible[k];
    while (sample >= static_cast<std::size_t>(this->SampleEnds[live])) {
      ++live;
    }
    const Ray& ray = this->Rays[static_cast<std::size_t>(this->Live[live])].ray;
    glm::vec4& color = this->Lit[sample];
    const glm::vec3 lit = lighting.shade(glm::vec3(color), lighting.toEye(ray),
                                         ray.at(this->Samples[sample].t), gradient);
    color = glm::vec4(lit, color.w);
  }
}

} // namespace inr
