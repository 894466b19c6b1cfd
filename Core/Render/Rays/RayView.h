// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Rays/LayersView.h"
#include "Core/Render/Rays/ProjectedVoxel.h"
#include "Core/Render/Rays/Ray.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <cstdint>

namespace inr {

/// The part of a line that survives clipping.
struct LineInterval
{
  double begin;
  double end;

  /// Keeps where value + slope * t >= 0.
  INR_HOST_DEVICE void keep(double value, double slope) { this->keep(value, slope, 1.0 / slope); }
  INR_HOST_DEVICE void keep(double value, double slope, double inverse)
  {
    if (slope > 0) {
      this->begin = glm::max(this->begin, -value * inverse);
    } else if (slope < 0) {
      this->end = glm::min(this->end, -value * inverse);
    } else if (value < 0) {
      this->end = -Infinite;
    }
  }
};

/// The line through the centre of a pixel.
struct PixelLine
{
  glm::dvec4 center; ///< at clip-space z = 0, in world space
  glm::dvec3 near;
  glm::dvec3 toFar;
  double range; ///< from near to far
  glm::dvec3 forward;
  glm::dvec4 towardsFar; ///< of clip space

  INR_HOST_DEVICE static glm::dvec3 point(const glm::dvec4& homogeneous)
  {
    return glm::dvec3(homogeneous) * (1.0 / homogeneous.w);
  }
  /// World distance from the near plane to a window-space depth.
  INR_HOST_DEVICE double distanceTo(double depth) const
  {
    const glm::dvec3 place = point(this->center + this->towardsFar * (2.0 * depth - 1.0));
    return glm::dot(place - this->near, this->forward);
  }
};

/// How long a unit of t is. Plain data.
struct UnitOfT
{
  double length = 0;             ///< in the medium, see RayGeometry
  glm::dmat3 worldToMedium{1.0}; ///< see Frame
  bool isWorldMedium = true;     ///< whether lengths are the same in both

  /// World length along a world unit vector.
  INR_HOST_DEVICE double along(const glm::dvec3& direction) const
  {
    return this->isWorldMedium ? this->length
                               : this->length / glm::length(this->worldToMedium * direction);
  }
};

/// A RayGeometry as plain data, whose arrays lie in the memory of whoever reads it.
struct RayView
{
  int width = 0;
  int height = 0;
  glm::dmat4 clipToWorld{1.0};
  glm::dmat4 worldToIndex{1.0};
  glm::dmat3 indexToWorld{1.0}; ///< of directions
  glm::dmat4 indexToClip{1.0};
  glm::dvec3 low{0.0}; ///< of what is shown
  glm::dvec3 high{0.0};
  UnitOfT unit;
  ProjectedVoxel voxel;               ///< in world lengths
  const float* opaqueDepth = nullptr; ///< see Frame; may be null
  const glm::dvec4* planes = nullptr; ///< Frame::clippingPlanes
  int planeCount = 0;
  const glm::dvec4* piece = nullptr; ///< Frame::piece
  int pieceCount = 0;
  LayersView layers; ///< of Frame::layers

  INR_HOST_DEVICE PixelLine line(int x, int y) const
  {
    const double clipX = 2.0 * (x + 0.5) / this->width - 1.0;
    const double clipY = 2.0 * (y + 0.5) / this->height - 1.0;
    const glm::dmat4& toWorld = this->clipToWorld;
    const glm::dvec4 center = toWorld[0] * clipX + toWorld[1] * clipY + toWorld[3];
    const glm::dvec3 near = PixelLine::point(center - toWorld[2]);
    const glm::dvec3 toFar = PixelLine::point(center + toWorld[2]) - near;
    const double range = glm::length(toFar);
    return {center, near, toFar, range, toFar / range, toWorld[2]};
  }

  INR_HOST_DEVICE std::int64_t pixel(int x, int y) const
  {
    return std::int64_t{y} * this->width + x;
  }
  INR_HOST_DEVICE int column(std::int64_t pixel) const
  {
    return static_cast<int>(pixel % this->width);
  }
  INR_HOST_DEVICE int row(std::int64_t pixel) const
  {
    return static_cast<int>(pixel / this->width);
  }

  /// See RayGeometry.
  INR_HOST_DEVICE Ray ray(int x, int y) const
  {
    const PixelLine line = this->line(x, y);
    return this->clipped(line, x, y, 0.0, line.range);
  }
  INR_HOST_DEVICE Ray ray(int x, int y, int part) const
  {
    const PixelLine line = this->line(x, y);
    const std::int64_t pixel = this->pixel(x, y);
    const double begin = part > 0 ? line.distanceTo(this->layers.depth(part - 1, pixel)) : 0.0;
    const float depth = this->layers.depth(part, pixel);
    const double end = depth < 1.0f ? line.distanceTo(depth) : line.range;
    return this->clipped(line, x, y, begin, end);
  }
  INR_HOST_DEVICE Ray rayThroughPiece(int x, int y) const
  {
    Ray ray = this->ray(x, y);
    if (ray.length > 0) {
      ray.entry = ray.at(ray.pieceBegin);
      ray.length = glm::min(ray.length, ray.pieceEnd) - ray.pieceBegin;
      ray.footprint += ray.footprintGrowth * ray.pieceBegin;
      ray.pieceBegin = 0;
      ray.pieceEnd = Infinite;
    }
    return ray;
  }

  /// Of a pixel's line what is between two world distances from the near plane.
  INR_HOST_DEVICE Ray clipped(const PixelLine& line, int x, int y, double begin, double end) const
  {
    const glm::dvec3 origin(this->worldToIndex * glm::dvec4(line.near, 1.0));
    const glm::dvec3 direction(this->worldToIndex * glm::dvec4(line.forward, 0.0));
    LineInterval world{begin, end};
    const glm::dvec3 inverse = 1.0 / direction;
    for (int axis = 0; axis < 3; ++axis) {
      world.keep(origin[axis] - this->low[axis], direction[axis], inverse[axis]);
      world.keep(this->high[axis] - origin[axis], -direction[axis], -inverse[axis]);
    }
    keepAbove(this->planes, this->planeCount, line, world);
    if (this->opaqueDepth != nullptr) {
      const double depth = this->opaqueDepth[this->pixel(x, y)];
      if (depth < 1.0) {
        world.end = glm::min(world.end, line.distanceTo(depth));
      }
    }
    LineInterval kept = world;
    keepAbove(this->piece, this->pieceCount, line, kept);
    Ray ray;
    if (kept.begin < kept.end) { // false, too, where something was not a number
      const double worldPerT = this->unit.along(line.forward);
      ray.entry = origin + world.begin * direction;
      ray.direction = direction * worldPerT;
      ray.inverse = inverse / worldPerT;
      ray.length = (world.end - world.begin) / worldPerT;
      ray.pieceBegin = (kept.begin - world.begin) / worldPerT;
      if (kept.end < world.end) {
        ray.pieceEnd = (kept.end - world.begin) / worldPerT;
      }
      this->findFootprint(line, world.begin, ray);
      ray.footprintGrowth *= worldPerT;
    }
    return ray;
  }

  /// Window-space depth in [0, 1] of a point on a ray.
  INR_HOST_DEVICE double windowDepth(const glm::dvec3& index) const
  {
    const glm::dvec4 clip = this->indexToClip * glm::dvec4(index, 1.0);
    return glm::clamp(0.5 * (clip.z / clip.w + 1.0), 0.0, 1.0);
  }

private:
  INR_HOST_DEVICE static void keepAbove(const glm::dvec4* planes, int count, const PixelLine& line,
                                        LineInterval& kept)
  {
    for (int k = 0; k < count; ++k) {
      kept.keep(glm::dot(planes[k], glm::dvec4(line.near, 1.0)),
                glm::dot(planes[k], glm::dvec4(line.forward, 0.0)));
    }
  }

  /// A pixel's edge grows linearly from the near to the far plane. Leaves its growth that of a
  /// world length.
  INR_HOST_DEVICE void findFootprint(const PixelLine& line, double begin, Ray& ray) const
  {
    const glm::dvec4 next = line.center + this->clipToWorld[0] * (2.0 / this->width);
    const double atNear = glm::length(PixelLine::point(next - line.towardsFar) - line.near);
    const double atFar =
        glm::length(PixelLine::point(next + line.towardsFar) - line.near - line.toFar);
    const double growth = (atFar - atNear) / line.range;
    const double voxel = this->voxel.across(line.forward);
    ray.footprint = (atNear + growth * begin) / voxel;
    ray.footprintGrowth = growth / voxel;
  }
};

} // namespace inr
