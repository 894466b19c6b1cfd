// SPDX-License-Identifier: BSD-3-Clause
//
// Lights as the inner loops of marching take them. Plain data.
#pragma once

namespace inr {

/// A light that is infinitely far away.
struct DiffuseLight
{
  float toLight[3]; ///< world unit vector
  float rgb[3]; ///< of what a white surface that faces it shows, times the material's diffuse part
};

/// All that lights a surface without highlights, by lights that shine alike everywhere: there, see
/// Shading, a sample's colour is multiplied with ambient + sum over lights of rgb * |n.l|.
struct DiffuseLights
{
  const DiffuseLight* lights;
  int count;
  float ambient;
  /// Takes a gradient per voxel of level 0 to world space, up to a factor: the largest element is 1
  /// or -1. Row by row.
  float gradientToWorld[3][3];
};

} // namespace inr
