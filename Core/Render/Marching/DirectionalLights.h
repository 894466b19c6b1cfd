// SPDX-License-Identifier: BSD-3-Clause
//
// Lights as the inner loops of marching take them. Plain data.
#pragma once

namespace inr {

struct DirectionalLight
{
  float toLight[3]; ///< world unit vector
  float rgb[3];     ///< what a white surface that faces it shows
};

/// Lights that are infinitely far away, and nothing else, on a volume's samples: see Shading.
struct DirectionalLights
{
  const DirectionalLight* lights;
  int count;
  float ambient;
  float diffuse;
  float specular;
  int specularPower; ///< a whole number, not negative, which powers are made of by squaring
  /// Cosine below which highlights are as good as none: powers of smaller ones would take
  /// processors long that number so little.
  float leastMirrored;
  /// Takes a gradient per voxel of level 0 to world space, up to a factor: the largest element is 1
  /// or -1. Row by row.
  float gradientToWorld[3][3];
};

} // namespace inr
