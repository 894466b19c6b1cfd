// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Rays/RayView.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// Opacity at which the rest of a ray no longer shows.
constexpr float OpaqueEnough = 0.999f;
constexpr float OpaqueTransmittance = 1.0f - OpaqueEnough;

/// What a ray has gathered that goes from layer to layer: the volume's light as it comes through.
class LayeredLight
{
public:
  /// Takes in what the ray has gathered since the last call: all so far is `color`, premultiplied
  /// light of the volume alone, and `transmittance`.
  INR_HOST_DEVICE void gather(const glm::vec3& color, float transmittance)
  {
    this->Seen += this->Front.passes * (color - this->Color) +
                  (this->Transmittance - transmittance) * this->Front.color;
    this->Color = color;
    this->Transmittance = transmittance;
  }
  /// Goes on behind a surface.
  INR_HOST_DEVICE void pass(const glm::vec4& surface) { this->Front.addBehind(surface); }
  /// How much of the light further behind is seen.
  INR_HOST_DEVICE float passes() const { return this->Front.passes; }
  INR_HOST_DEVICE const glm::vec3& seen() const { return this->Seen; }

private:
  Veil Front;
  glm::vec3 Seen{0.0f};
  glm::vec3 Color{0.0f};
  float Transmittance = 1;
};

/// A ray's way from one translucent layer to the next; see RayView::ray.
struct LayeredWay
{
  int part = 0; ///< how many layers lie behind
  LayeredLight light;
  double halfOpaqueDepth = -1; ///< in window space, of parts that have ended; -1 = not yet

  /// At the end of a part of the way, which is `ray`: takes in what the ray has gathered so far,
  /// premultiplied light and the transmittance, and goes on behind the layer there. False where
  /// there is none, or where nothing behind it is seen. `halfOpaqueAt`: t on that part or one
  /// before; -1 = not yet.
  INR_HOST_DEVICE bool enterNextPart(const RayView& rays, std::int64_t pixel, const Ray& ray,
                                     const glm::vec3& color, float transmittance,
                                     double halfOpaqueAt)
  {
    this->light.gather(color, transmittance);
    this->noteHalfOpaque(rays, ray, halfOpaqueAt);
    if (transmittance <= OpaqueTransmittance || rays.layers.depth(this->part, pixel) >= 1.0f) {
      return false;
    }
    this->light.pass(rays.layers.color(this->part, pixel));
    if (this->light.passes() <= 0.0f) {
      return false;
    }
    ++this->part;
    return true;
  }

private:
  INR_HOST_DEVICE void noteHalfOpaque(const RayView& rays, const Ray& ray, double at)
  {
    if (at >= 0 && this->halfOpaqueDepth < 0) {
      this->halfOpaqueDepth = rays.windowDepth(ray.at(at));
    }
  }
};

} // namespace inr
