// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Rays/RayGeometry.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include <vector>

namespace inr {

/// A direction as rays along it need it.
struct RayDirection
{
  glm::dvec3 perT;    ///< point indices per unit of t
  glm::dvec3 inverse; ///< 1 / perT
  double worldPerT;   ///< world length of a unit of t
};

/// Rays that start inside the volume. Plain data. Directions and lengths are the world's, whatever
/// spacing or shear lies between it and the grid.
class InnerRays
{
public:
  /// `geometry` has checked the frame. `planes` becomes its clipping planes over point indices, and
  /// must outlive this.
  InnerRays(const Frame& frame, const RayGeometry& geometry, const glm::i64vec3& dims,
            std::vector<glm::dvec4>& planes);

  const glm::dvec4* planes() const { return this->Planes; }
  int planeCount() const { return this->PlaneCount; }
  /// The same with its planes elsewhere.
  InnerRays with(const glm::dvec4* planes) const
  {
    InnerRays rays = *this;
    rays.Planes = planes;
    return rays;
  }

  /// The ray from point index `from` along the world unit vector `direction`, clipped to the
  /// visible domain (point bounds), the clipping planes and `limit`, a world length. Neither the
  /// camera's near and far planes nor opaque geometry stop it. Its footprint is left at 0.
  INR_HOST_DEVICE Ray ray(const glm::dvec3& from, const glm::dvec3& direction,
                          double limit = Infinite) const
  {
    Ray ray;
    this->aim(ray, from, this->along(direction), limit);
    return ray;
  }

  /// `direction`: a world unit vector.
  INR_HOST_DEVICE RayDirection along(const glm::dvec3& direction) const
  {
    const double worldPerT = this->Unit.along(direction);
    const glm::dvec3 perT = this->ToIndex * direction * worldPerT;
    return {perT, 1.0 / perT, worldPerT};
  }

  /// Makes of `ray` the one above, where it stands: copies of what was written a moment ago wait
  /// for it.
  INR_HOST_DEVICE void aim(Ray& ray, const glm::dvec3& from, const RayDirection& direction,
                           double limit = Infinite) const
  {
    ray.entry = from;
    ray.direction = direction.perT;
    ray.inverse = direction.inverse;
    ray.length = limit / direction.worldPerT;
    for (int axis = 0; axis < 3; ++axis) {
      // A start that rounding has put outside counts as being on the border.
      const double face = ray.direction[axis] < 0 ? this->Low[axis] : this->High[axis];
      const double end = glm::max((face - from[axis]) * ray.inverse[axis], 0.0);
      ray.length = ray.direction[axis] != 0 && end < ray.length ? end : ray.length;
    }
    for (int k = 0; k < this->PlaneCount; ++k) {
      Keep(glm::dot(this->Planes[k], glm::dvec4(from, 1.0)),
           glm::dot(this->Planes[k], glm::dvec4(ray.direction, 0.0)), ray.length);
    }
  }

  INR_HOST_DEVICE glm::dvec3 world(const glm::dvec3& index) const
  {
    return glm::dvec3(this->ToWorld * glm::dvec4(index, 1.0));
  }
  /// World unit vector of a direction in point indices.
  INR_HOST_DEVICE glm::dvec3 worldDirection(const glm::dvec3& direction) const
  {
    return glm::normalize(glm::dmat3(this->ToWorld) * direction);
  }

private:
  /// Ends the ray where value + slope * t falls below 0. A start that rounding has put outside
  /// counts as being on the border.
  INR_HOST_DEVICE static void Keep(double value, double slope, double& length)
  {
    if (slope < 0) {
      const double end = value > 0 ? -value / slope : 0.0;
      length = end < length ? end : length;
    }
  }

  glm::dmat4 ToWorld;
  glm::dmat3 ToIndex;
  glm::dvec3 Low;
  glm::dvec3 High;
  const glm::dvec4* Planes; ///< over point indices
  int PlaneCount;
  UnitOfT Unit;
};

} // namespace inr
