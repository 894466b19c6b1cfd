// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Ray.h"

#include "Core/Error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace inr {

namespace {

/// Keeps a ray's lattice of samples within 64 bits for any volume.
constexpr double SmallestStep = 1e-3;
constexpr double LargestStep = 1e6;
constexpr std::int64_t MaximumPixels = std::int64_t{1} << 28;

void Require(bool condition, const char* message)
{
  if (!condition) {
    throw Error(ErrorCode::InvalidArgument, message);
  }
}

bool IsFinite(const glm::dmat4& matrix)
{
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (!std::isfinite(matrix[c][r])) {
        return false;
      }
    }
  }
  return true;
}

bool IsValid(const Material& material)
{
  for (const float part :
       {material.ambient, material.diffuse, material.specular, material.specularPower}) {
    if (!(part >= 0) || !std::isfinite(part)) {
      return false;
    }
  }
  return true;
}

glm::dmat4 Inverse(const glm::dmat4& matrix, const char* message)
{
  const glm::dmat4 inverse = glm::inverse(matrix);
  Require(IsFinite(matrix) && IsFinite(inverse), message);
  return inverse;
}

glm::dvec3 Point(const glm::dvec4& homogeneous)
{
  return glm::dvec3(homogeneous) * (1.0 / homogeneous.w);
}

/// Cuts off what is not in the ray's piece.
void KeepPiece(Ray& ray)
{
  if (ray.length > 0) {
    ray.entry = ray.at(ray.pieceBegin);
    ray.length = std::min(ray.length, ray.pieceEnd) - ray.pieceBegin;
    ray.footprint += ray.footprintGrowth * ray.pieceBegin;
    ray.pieceBegin = 0;
    ray.pieceEnd = std::numeric_limits<double>::infinity();
  }
}

/// The part of a line that survives clipping.
struct Interval
{
  double begin;
  double end;

  /// Keeps where value + slope * t >= 0.
  void keep(double value, double slope)
  {
    if (slope > 0) {
      this->begin = std::max(this->begin, -value / slope);
    } else if (slope < 0) {
      this->end = std::min(this->end, -value / slope);
    } else if (value < 0) {
      this->end = -std::numeric_limits<double>::infinity();
    }
  }
};

} // namespace

RayGeometry::RayGeometry(const Frame& frame, const glm::i64vec3& dims) : Picture(frame)
{
  Require(frame.width > 0 && frame.height > 0, "a picture needs at least one pixel");
  if (std::int64_t{frame.width} * frame.height > MaximumPixels) {
    throw Error(ErrorCode::TooLarge, "a picture of " + std::to_string(frame.width) + " x " +
                                         std::to_string(frame.height) +
                                         " pixels; render it in tiles of at most 2^28");
  }
  Require(frame.sampleDistance >= SmallestStep && frame.sampleDistance <= LargestStep,
          "the sample distance must be between 1/1000 and 1,000,000 voxels");
  Require(!frame.errorTolerance ||
              (*frame.errorTolerance >= 0 && std::isfinite(*frame.errorTolerance)),
          "the error tolerance must be a number, and not negative");
  Require(frame.levelOfDetailScale >= 0 && std::isfinite(frame.levelOfDetailScale),
          "the level-of-detail scale must be finite and not negative");
  Require(!frame.shading || IsValid(*frame.shading),
          "ambient, diffuse, specular and specular power must be finite and not negative");
  Require(frame.timeLimit >= 0, "the time limit must not be negative");
  Require(frame.mode == RenderMode::RayMarching || frame.blending.mode == BlendMode::Composite,
          "paths are composited; choose ray marching for another blend mode");
  Require(!std::isnan(frame.blending.averageLow) && !std::isnan(frame.blending.averageHigh),
          "the range of averaged values must consist of numbers");
  Require(std::all_of(frame.blending.isosurfaces.begin(), frame.blending.isosurfaces.end(),
                      [](double value) { return std::isfinite(value); }),
          "the values of isosurfaces must be finite");
  Require(std::isfinite(frame.unitDistance) && frame.unitDistance > 0,
          "the opacity unit distance must be above 0");
  this->WorldToClip = Inverse(frame.clipToWorld, "the camera's matrix has no inverse");
  this->IndexToWorld =
      Inverse(frame.worldToIndex, "the volume's matrix has no inverse (a zero scale or spacing?)");
  this->WorldPerUnit = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    // A single layer of voxels is a slab one spacing thick; else the domain ends at the outer
    // points.
    this->Low[axis] = dims[axis] == 1 ? -0.5 : 0.0;
    this->High[axis] = dims[axis] == 1 ? 0.5 : static_cast<double>(dims[axis] - 1);
    this->WorldPerUnit =
        std::min(this->WorldPerUnit, glm::length(glm::dvec3(this->IndexToWorld[axis])));
  }
  Require(this->WorldPerUnit > 0, "the volume is flat in world space");
  if (frame.cropping) {
    Require(!glm::any(glm::isnan(frame.cropping->low + frame.cropping->high)),
            "cropping planes must be at numbers");
    const CroppedBox box = BoxOf(*frame.cropping);
    Require(box.full || frame.mode == RenderMode::RayMarching,
            "paths can be cropped to a box of regions only");
    this->Low = glm::max(this->Low, box.low);
    this->High = glm::min(this->High, box.high);
  }
  Require(!frame.layers || !frame.blending.projects(),
          "a projection has no depth at which to meet translucent layers; leave them out");
  Require(
      !frame.layers || frame.layers->fits(std::int64_t{frame.width} * frame.height),
      "translucent layers need a depth and a colour for each pixel, each behind the one before");
}

struct RayGeometry::Line
{
  glm::dvec4 center; ///< at clip-space z = 0, in world space
  glm::dvec3 near;
  glm::dvec3 toFar;
  double range; ///< from near to far
  glm::dvec3 forward;
  glm::dvec4 towardsFar; ///< of clip space

  /// World distance from the near plane to a window-space depth.
  double distanceTo(double depth) const
  {
    const glm::dvec3 place = Point(this->center + this->towardsFar * (2.0 * depth - 1.0));
    return glm::dot(place - this->near, this->forward);
  }
};

RayGeometry::Line RayGeometry::line(int x, int y) const
{
  const double clipX = 2.0 * (x + 0.5) / this->Picture.width - 1.0;
  const double clipY = 2.0 * (y + 0.5) / this->Picture.height - 1.0;
  const glm::dmat4& toWorld = this->Picture.clipToWorld;
  const glm::dvec4 center = toWorld[0] * clipX + toWorld[1] * clipY + toWorld[3];
  const glm::dvec3 near = Point(center - toWorld[2]);
  const glm::dvec3 toFar = Point(center + toWorld[2]) - near;
  const double range = glm::length(toFar);
  return {center, near, toFar, range, toFar / range, toWorld[2]};
}

double RayGeometry::longest() const
{
  const glm::dvec3 size = this->High - this->Low;
  double longest = 0;
  for (int corner = 0; corner < 4; ++corner) { // and the four opposite ones
    const glm::dvec3 diagonal(size.x, (corner & 1) != 0 ? -size.y : size.y,
                              (corner & 2) != 0 ? -size.z : size.z);
    longest = std::max(longest, glm::length(glm::dmat3(this->IndexToWorld) * diagonal));
  }
  return longest / this->WorldPerUnit;
}

Ray RayGeometry::ray(int x, int y) const
{
  const Line line = this->line(x, y);
  return this->clipped(line, x, y, 0.0, line.range);
}

Ray RayGeometry::ray(int x, int y, int part) const
{
  const Line line = this->line(x, y);
  double begin = 0.0;
  double end = line.range;
  if (this->Picture.layers) {
    const TranslucentLayers& layers = *this->Picture.layers;
    const auto pixel = static_cast<std::size_t>(y) * this->Picture.width + x;
    begin = part > 0 ? line.distanceTo(layers.depth(part - 1, pixel)) : begin;
    end = layers.depth(part, pixel) < 1.0f ? line.distanceTo(layers.depth(part, pixel)) : end;
  }
  return this->clipped(line, x, y, begin, end);
}

Ray RayGeometry::clipped(const Line& line, int x, int y, double begin, double end) const
{
  const glm::dvec3& near = line.near;
  const glm::dvec3& forward = line.forward;
  const glm::dvec3 origin(this->Picture.worldToIndex * glm::dvec4(near, 1.0));
  const glm::dvec3 direction(this->Picture.worldToIndex * glm::dvec4(forward, 0.0));
  Interval world{begin, end};
  for (int axis = 0; axis < 3; ++axis) {
    world.keep(origin[axis] - this->Low[axis], direction[axis]);
    world.keep(this->High[axis] - origin[axis], -direction[axis]);
  }
  for (const glm::dvec4& plane : this->Picture.clippingPlanes) {
    world.keep(glm::dot(plane, glm::dvec4(near, 1.0)), glm::dot(plane, glm::dvec4(forward, 0.0)));
  }
  if (this->Picture.opaqueDepth != nullptr) {
    const auto pixel = static_cast<std::size_t>(y) * this->Picture.width + x;
    const double depth = this->Picture.opaqueDepth[pixel];
    if (depth < 1.0) {
      world.end = std::min(world.end, line.distanceTo(depth));
    }
  }
  Interval piece{world.begin, world.end};
  for (const glm::dvec4& plane : this->Picture.piece) {
    piece.keep(glm::dot(plane, glm::dvec4(near, 1.0)), glm::dot(plane, glm::dvec4(forward, 0.0)));
  }
  Ray ray;
  if (piece.begin < piece.end) { // false, too, where something was not a number
    ray.entry = origin + world.begin * direction;
    ray.direction = direction * this->WorldPerUnit;
    ray.inverse = 1.0 / ray.direction;
    ray.length = (world.end - world.begin) / this->WorldPerUnit;
    ray.pieceBegin = (piece.begin - world.begin) / this->WorldPerUnit;
    if (piece.end < world.end) {
      ray.pieceEnd = (piece.end - world.begin) / this->WorldPerUnit;
    }
    // A pixel's edge grows linearly from the near to the far plane.
    const glm::dvec4 next =
        line.center + this->Picture.clipToWorld[0] * (2.0 / this->Picture.width);
    const double atNear = glm::length(Point(next - line.towardsFar) - near);
    const double atFar = glm::length(Point(next + line.towardsFar) - near - line.toFar);
    ray.footprintGrowth = (atFar - atNear) / line.range;
    ray.footprint = (atNear + ray.footprintGrowth * world.begin) / this->WorldPerUnit;
  }
  return ray;
}

Ray RayGeometry::rayThroughPiece(int x, int y) const
{
  Ray ray = this->ray(x, y);
  KeepPiece(ray);
  return ray;
}

double RayGeometry::windowDepth(const glm::dvec3& index) const
{
  const glm::dvec4 clip = this->WorldToClip * (this->IndexToWorld * glm::dvec4(index, 1.0));
  return std::clamp(0.5 * (clip.z / clip.w + 1.0), 0.0, 1.0);
}

} // namespace inr
