// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

namespace inr {

/// A pixel's way through the volume. Parameter t counts from the ray's own entry, in voxels of the
/// densest axis (see RayGeometry::lengthPerUnit), so that its digits are spent inside the volume
/// wherever that lies in the world.
struct Ray
{
  glm::dvec3 entry{0.0};     ///< point indices at t = 0
  glm::dvec3 direction{0.0}; ///< point indices per unit of t
  glm::dvec3 inverse{0.0};   ///< 1 / direction
  double length = 0;         ///< t where the ray leaves or meets something opaque; <= 0: a miss
  double footprint = 0; ///< edge of the pixel at t = 0, in voxels as large as the ray sees them
  double footprintGrowth = 0; ///< of the footprint per unit of t
  double pieceBegin = 0;      ///< t between which the picture's piece of the medium is
  double pieceEnd = Infinite;

  INR_HOST_DEVICE glm::dvec3 at(double t) const { return this->entry + t * this->direction; }
  /// Every place belongs to one of the pieces that make up the whole.
  INR_HOST_DEVICE bool isInPiece(double t) const
  {
    return t >= this->pieceBegin && t < this->pieceEnd;
  }
};

} // namespace inr
