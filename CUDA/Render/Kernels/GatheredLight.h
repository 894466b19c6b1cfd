// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Marching/RayMarching.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>

namespace inr {
namespace cuda {

/// The light that a ray has gathered from its samples. A few of them, a part, are summed up in
/// float, and parts in double, which many GPUs are slow at. Where a part ends is a matter of how
/// many samples there were, so that it does not matter where a ray had to wait.
class GatheredLight
{
public:
  static constexpr std::uint32_t SamplesOfPart = 64;

  /// Of all light that comes from behind, what is still let through.
  INR_HOST_DEVICE float through() const { return this->Through; }
  INR_HOST_DEVICE bool isHalfOpaque() const { return this->Through <= 0.5f; }
  /// Whether what is behind no longer shows.
  INR_HOST_DEVICE bool isOpaque() const { return this->Through <= OpaqueTransmittance; }
  INR_HOST_DEVICE std::uint32_t samples() const { return this->Samples; } ///< counted so far

  /// From the next sample, which is counted.
  INR_HOST_DEVICE void add(const glm::vec4& color, float opacity)
  {
    this->addMore(color, opacity);
    this->count();
  }
  /// From what is not counted.
  INR_HOST_DEVICE void addMore(const glm::vec4& color, float opacity)
  {
    const float weight = this->Through * opacity;
    for (int channel = 0; channel < 3; ++channel) {
      this->Part[channel] = fmaf(color[channel], weight, this->Part[channel]);
    }
    this->Held += weight;
    this->Through -= weight;
  }
  /// A sample that has nothing to add.
  INR_HOST_DEVICE void count()
  {
    ++this->Samples;
    if (this->Samples % SamplesOfPart == 0) {
      this->endPart();
    }
  }

  /// Premultiplied, and what is let through.
  INR_HOST_DEVICE glm::dvec4 sum() const { return this->Sum + glm::dvec4(this->Part, -this->Held); }

private:
  INR_HOST_DEVICE void endPart()
  {
    this->Sum = this->sum();
    this->Part = glm::vec3(0.0f);
    this->Held = 0.0f;
    this->Through = static_cast<float>(this->Sum.w);
  }

  glm::dvec4 Sum{0.0, 0.0, 0.0, 1.0}; ///< up to the present part
  glm::vec3 Part{0.0f};
  float Held = 0.0f; ///< by the part
  float Through = 1.0f;
  std::uint32_t Samples = 0;
};

} // namespace cuda
} // namespace inr
