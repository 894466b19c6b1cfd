// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace inr {

/// What a medium does with light, apart from its transfer function.
struct PathOptions
{
  int maximumBounces = 16;      ///< scatterings of a path, not negative
  float scatteringAlbedo = 1;   ///< in [0, 1]; multiplies the transfer function's colour
  double anisotropy = 0;        ///< mean cosine of a scattering, in (-1, 1)
  glm::vec3 ambientLight{0.0f}; ///< radiance from everywhere outside; never the backdrop
  /// The medium shines with the transfer function's colour and scatters nothing: the picture that
  /// ray marching makes.
  bool emissionOnly = false;
  /// Scatterings after which a path ends at random, by how little light it still carries.
  int rouletteAfter = 4;

  bool operator==(const PathOptions& other) const
  {
    return this->maximumBounces == other.maximumBounces &&
           this->scatteringAlbedo == other.scatteringAlbedo &&
           this->anisotropy == other.anisotropy && this->ambientLight == other.ambientLight &&
           this->emissionOnly == other.emissionOnly && this->rouletteAfter == other.rouletteAfter;
  }
};

} // namespace inr
