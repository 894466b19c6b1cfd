// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Rays/RayView.h"
#include "Core/Render/Scene/Frame.h"

#include <glm/gtc/type_precision.hpp>

#include <vector>

namespace inr {

/// A Frame's geometry composed in double, once: rays in index space and back to window depth.
class RayGeometry
{
public:
  /// Throws Error(InvalidArgument) for singular or non-finite matrices, a far plane at infinity;
  /// else the frame is valid. Its arrays must outlive this.
  RayGeometry(const Frame& frame, const glm::i64vec3& dims);
  RayGeometry(const RayGeometry&) = delete;
  RayGeometry& operator=(const RayGeometry&) = delete;
  RayGeometry(RayGeometry&&) = default; ///< arrays stay where they are

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
  double windowDepth(const glm::dvec3& index) const { return this->View.windowDepth(index); }

  /// t that the longest ray spends in the volume, at most.
  double longest() const;

  /// Length in the medium (see Frame::worldToMedium) of one unit of t: the shortest voxel edge.
  double lengthPerUnit() const { return this->View.unit.length; }

  /// What makes rays anywhere, as long as this and the frame's arrays live.
  const RayView& view() const { return this->View; }

private:
  std::vector<SurfaceLayer> Layers; ///< of the view
  RayView View;
};

} // namespace inr
