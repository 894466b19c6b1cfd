// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Marching/DirectionalLights.h"
#include "Core/Render/Marching/ShadingView.h"
#include "Core/Render/Scene/Frame.h"

#include <optional>
#include <vector>

namespace inr {

/// Gradient shading after Phong (1975), as VTK has it from 9.2 on: with n the direction of the
/// field's gradient, l the one to a light, v the one to the eye and r = 2 (n.l) n - l,
///
///   colour * ambient + sum over lights of (colour * diffuse * |n.l| + specular * (r.v)^power) * I
///
/// where both sides of a surface are lit, r.v is taken as 0 where it is below, and a sample without
/// a gradient gets the ambient part only. I is the light's colour at the place.
class Shading
{
public:
  /// Of `frame`, which must say how to shade and have been checked by a RayGeometry.
  explicit Shading(const Frame& frame);

  Shading(Shading&&) noexcept = default;
  Shading& operator=(Shading&&) noexcept = default;

  /// What shades: a sample's straight RGB, where the field changes by a gradient per voxel of level
  /// 0. As long as this lives, or what it is moved to.
  const ShadingView& view() const { return this->View; }

  /// The same for the kernels; null where a light is somewhere, or the power of highlights no
  /// whole number up to 128. As long as this lives, or what it is moved to.
  const DirectionalLights* directional() const
  {
    return this->Directional ? &*this->Directional : nullptr;
  }

private:
  DirectionalLights takeDirectional();

  std::vector<Light> Lights;
  std::vector<Illumination> Constant; ///< of the directional lights, which come first
  ShadingView View;
  std::vector<DirectionalLight> DirectionalEach; ///< where that is all there is
  std::optional<DirectionalLights> Directional;
};

/// None when `frame` is not shaded; projected values have no surface.
inline std::optional<Shading> ShadingOf(const Frame& frame)
{
  const bool lit = frame.shading && !frame.blending.projects();
  return lit ? std::optional<Shading>(frame) : std::nullopt;
}

} // namespace inr
