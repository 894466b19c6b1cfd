// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Grid/NativeGrid.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

/// All x with dot(normal, x) + offset = 0, in world space; the normal has length 1.
struct Plane
{
  glm::dvec3 normal{0.0, 0.0, 1.0};
  double offset = 0;
};

/// Points and cells of a part of a plane. A cell is a convex polygon of the points
/// connectivity[offsets[k]] to connectivity[offsets[k + 1] - 1].
struct PlaneMesh
{
  std::vector<glm::dvec2> points; ///< in steps of the grid
  std::vector<std::int64_t> connectivity;
  std::vector<std::int64_t> offsets{0};
};

/// A regular grid of points on the plane, cut to the bounds of a volume: to the outermost voxels,
/// and to one spacing along an axis with a single voxel.
///
/// One direction of the grid is the projection of the volume's axis that is closest to the plane. A
/// step is the longest that goes at most one native voxel along any axis and divides the plane's
/// part within the bounds evenly: on a plane of voxels the points are the voxels. Where that gives
/// more than `maximumPoints` points to the rectangle around that part, the steps are longer.
class PlaneGrid
{
public:
  PlaneGrid(const NativeGrid& grid, const Plane& plane, std::int64_t maximumPoints);

  /// Points of the rectangle; 0 where the plane does not meet the bounds.
  std::int64_t GetNumberOfPoints() const { return this->Nodes.x * this->Nodes.y; }

  /// What lies within the bounds of piece number `piece` of `pieces`, in stripes of whole cells.
  PlaneMesh Mesh(int piece, int pieces) const;

  glm::dvec3 World(const glm::dvec2& point) const
  {
    return this->Corner + this->Steps[0] * point.x + this->Steps[1] * point.y;
  }
  /// Where in the unit cube the volume shows there.
  glm::dvec3 Unit(const glm::dvec2& point) const;

private:
  void Span(const glm::dvec3 (&directions)[2], const std::vector<glm::dvec3>& corners,
            std::int64_t maximumPoints);

  glm::dvec3 Dims;
  glm::dmat3 Indices; ///< world to native voxels
  glm::dvec3 Origin;
  glm::dvec3 Corner{0.0};
  glm::dvec3 Steps[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
  glm::i64vec2 Nodes{0};
  std::vector<glm::dvec2> Outline; ///< of the part within the bounds, in steps
};
