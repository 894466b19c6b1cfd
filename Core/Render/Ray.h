// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Frame.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <limits>

namespace inr {

/// A pixel's way through the volume. Parameter t counts from the ray's own entry, in voxels of the
/// densest axis, so that its digits are spent inside the volume wherever that lies in the world.
struct Ray
{
  glm::dvec3 entry{0.0};      ///< point indices at t = 0
  glm::dvec3 direction{0.0};  ///< point indices per unit of t
  glm::dvec3 inverse{0.0};    ///< 1 / direction
  double length = 0;          ///< t where the ray leaves or meets something opaque; <= 0: a miss
  double footprint = 0;       ///< edge of the pixel at t = 0, in units of t
  double footprintGrowth = 0; ///< of the footprint per unit of t
  double pieceBegin = 0;      ///< t between which the picture's piece of the medium is
  double pieceEnd = std::numeric_limits<double>::infinity();

  INR_HOST_DEVICE glm::dvec3 at(double t) const { return this->entry + t * this->direction; }
  /// Every place belongs to one of the pieces that make up the whole.
  INR_HOST_DEVICE bool isInPiece(double t) const
  {
    return t >= this->pieceBegin && t < this->pieceEnd;
  }
};

/// A Frame's geometry composed in double, once: rays in index space and back to window depth.
class RayGeometry
{
public:
  /// Throws Error(InvalidArgument) for singular or non-finite matrices and values out of range.
  RayGeometry(const Frame& frame, const glm::i64vec3& dims);

  /// The ray through the centre of pixel (x, y), clipped to near and far plane, the visible domain
  /// (point bounds), the clipping planes and the opaque depth; a miss where it misses the frame's
  /// piece.
  Ray ray(int x, int y) const;
  /// The part of it between two translucent layers: from layer `part` - 1, or its beginning, to
  /// layer `part`, or its end.
  Ray ray(int x, int y, int part) const;

  /// The same ray, entering where its piece begins and leaving where it ends.
  Ray rayThroughPiece(int x, int y) const;

  /// Window-space depth in [0, 1] of a point on a ray.
  double windowDepth(const glm::dvec3& index) const;

  /// t that the longest ray spends in the volume, at most.
  double longest() const;

  /// World length of one unit of t: the shortest voxel edge.
  double worldPerUnit() const { return this->WorldPerUnit; }

private:
  /// The line through the centre of a pixel.
  struct Line;
  Line line(int x, int y) const;
  Ray clipped(const Line& line, int x, int y, double begin, double end) const;

  const Frame& Picture;
  glm::dmat4 IndexToWorld;
  glm::dmat4 WorldToClip;
  glm::dvec3 Low; ///< of what is shown
  glm::dvec3 High;
  double WorldPerUnit = 0;
};

} // namespace inr
