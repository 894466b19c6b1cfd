// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace inr {

/// What surfaces that let light through do to the light behind them: `color` comes on top, and
/// `passes` of it gets past.
struct Veil
{
  glm::vec3 color{0.0f};
  float passes = 1;

  /// Puts a surface of premultiplied colour and opacity behind the others.
  INR_HOST_DEVICE void addBehind(const glm::vec4& surface)
  {
    this->color += this->passes * glm::vec3(surface);
    this->passes *= 1.0f - surface.w;
  }
};

/// TranslucentLayers::Layer as plain data, whose arrays lie in the memory of whoever reads it.
struct SurfaceLayer
{
  const float* depth;
  const glm::vec4* colors;
};

/// TranslucentLayers as plain data, which lies there, too.
struct LayersView
{
  const SurfaceLayer* layers = nullptr;
  int count = 0;

  INR_HOST_DEVICE bool any() const { return this->count > 0; }
  /// Window-space depth of a layer; 1 where there is none.
  INR_HOST_DEVICE float depth(int layer, std::int64_t pixel) const
  {
    return layer < this->count ? this->layers[layer].depth[pixel] : 1.0f;
  }
  INR_HOST_DEVICE const glm::vec4& color(int layer, std::int64_t pixel) const
  {
    return this->layers[layer].colors[pixel];
  }
  /// All that is in front of a window-space depth.
  INR_HOST_DEVICE Veil inFrontOf(double windowDepth, std::int64_t pixel) const
  {
    Veil veil;
    for (int layer = 0; this->depth(layer, pixel) < windowDepth; ++layer) {
      veil.addBehind(this->color(layer, pixel));
    }
    return veil;
  }
};

} // namespace inr
