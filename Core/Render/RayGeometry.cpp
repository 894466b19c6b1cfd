// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/RayGeometry.h"

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

/// As levels of detail see it: along an axis of a single voxel, coarser ones have no fewer.
ProjectedVoxel VoxelOf(const RayView& view, const glm::i64vec3& dims)
{
  glm::dmat3 edges(view.indexToWorld);
  double shortest = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] == 1) {
      edges[axis] = glm::dvec3(0.0);
    } else {
      shortest = std::min(shortest, glm::length(edges[axis]));
    }
  }
  return {edges, std::isfinite(shortest) ? shortest : 1.0};
}

} // namespace

RayGeometry::RayGeometry(const Frame& frame, const glm::i64vec3& dims)
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
  this->View.width = frame.width;
  this->View.height = frame.height;
  this->View.clipToWorld = frame.clipToWorld;
  this->View.worldToIndex = frame.worldToIndex;
  this->View.opaqueDepth = frame.opaqueDepth;
  this->View.planes = frame.clippingPlanes.data();
  this->View.planeCount = static_cast<int>(frame.clippingPlanes.size());
  this->View.piece = frame.piece.data();
  this->View.pieceCount = static_cast<int>(frame.piece.size());
  this->View.worldToClip = Inverse(frame.clipToWorld, "the camera's matrix has no inverse");
  this->View.indexToWorld =
      Inverse(frame.worldToIndex, "the volume's matrix has no inverse (a zero scale or spacing?)");
  this->View.worldToMedium = frame.worldToMedium;
  this->View.lengthPerUnit = std::numeric_limits<double>::infinity();
  const glm::dmat3 indexToMedium = frame.worldToMedium * glm::dmat3(this->View.indexToWorld);
  for (int axis = 0; axis < 3; ++axis) {
    // A single layer of voxels is a slab one spacing thick; else the domain ends at the outer
    // points.
    this->View.low[axis] = dims[axis] == 1 ? -0.5 : 0.0;
    this->View.high[axis] = dims[axis] == 1 ? 0.5 : static_cast<double>(dims[axis] - 1);
    this->View.lengthPerUnit = std::min(this->View.lengthPerUnit, glm::length(indexToMedium[axis]));
  }
  Require(this->View.lengthPerUnit > 0 && std::isfinite(glm::determinant(indexToMedium)),
          "the volume is flat, or not finite, where the lengths of the medium are measured");
  this->View.voxel = VoxelOf(this->View, dims);
  if (frame.cropping) {
    Require(!glm::any(glm::isnan(frame.cropping->low + frame.cropping->high)),
            "cropping planes must be at numbers");
    const CroppedBox box = BoxOf(*frame.cropping);
    Require(box.full || frame.mode == RenderMode::RayMarching,
            "paths can be cropped to a box of regions only");
    this->View.low = glm::max(this->View.low, box.low);
    this->View.high = glm::min(this->View.high, box.high);
  }
  Require(!frame.layers || !frame.blending.projects(),
          "a projection has no depth at which to meet translucent layers; leave them out");
  Require(
      !frame.layers || frame.layers->fits(std::int64_t{frame.width} * frame.height),
      "translucent layers need a depth and a colour for each pixel, each behind the one before");
  if (frame.layers) {
    for (const TranslucentLayers::Layer& layer : frame.layers->layers) {
      this->Layers.push_back({layer.depth.data(), layer.colors.data()});
    }
    this->View.layers = {this->Layers.data(), frame.layers->count()};
  }
}

double RayGeometry::longest() const
{
  const glm::dvec3 size = this->View.high - this->View.low;
  double longest = 0;
  for (int corner = 0; corner < 4; ++corner) { // and the four opposite ones
    const glm::dvec3 diagonal(size.x, (corner & 1) != 0 ? -size.y : size.y,
                              (corner & 2) != 0 ? -size.z : size.z);
    longest = std::max(longest, glm::length(this->View.worldToMedium *
                                            (glm::dmat3(this->View.indexToWorld) * diagonal)));
  }
  return longest / this->View.lengthPerUnit;
}

Ray RayGeometry::ray(int x, int y) const { return this->View.ray(x, y); }

Ray RayGeometry::ray(int x, int y, int part) const { return this->View.ray(x, y, part); }

Ray RayGeometry::rayThroughPiece(int x, int y) const { return this->View.rayThroughPiece(x, y); }

} // namespace inr
