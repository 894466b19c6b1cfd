// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Rays/RayGeometry.h"

#include "Core/Error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace inr {

namespace {

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

glm::dmat4 Inverse(const glm::dmat4& matrix, const char* message)
{
  const glm::dmat4 inverse = glm::inverse(matrix);
  Require(IsFinite(matrix) && IsFinite(inverse), message);
  return inverse;
}

/// Whether doubles tell how far away it is. A homogeneous coordinate is the inverse of a distance,
/// and the far plane's is the difference of two as large as the near plane's.
bool HasFarPlane(const glm::dmat4& clipToWorld)
{
  constexpr double smallestRatio = 1e-12;
  const double middle = clipToWorld[3].w;
  const double half = clipToWorld[2].w;
  return std::abs(middle + half) >= smallestRatio * std::abs(middle - half);
}

/// As levels of detail see it: along an axis of a single voxel, coarser ones have no fewer.
ProjectedVoxel VoxelOf(const RayView& view, const glm::i64vec3& dims)
{
  glm::dmat3 edges = view.indexToWorld;
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
  this->View.width = frame.width;
  this->View.height = frame.height;
  this->View.clipToWorld = frame.clipToWorld;
  this->View.worldToIndex = frame.worldToIndex;
  this->View.opaqueDepth = frame.opaqueDepth;
  this->View.planes = frame.clippingPlanes.data();
  this->View.planeCount = static_cast<int>(frame.clippingPlanes.size());
  this->View.piece = frame.piece.data();
  this->View.pieceCount = static_cast<int>(frame.piece.size());
  Inverse(frame.clipToWorld, "the camera's matrix has no inverse");
  Require(HasFarPlane(frame.clipToWorld),
          "the camera's far plane is more than 1e12 times as far away as its near plane");
  this->View.indexToWorld = glm::dmat3(
      Inverse(frame.worldToIndex, "the volume's matrix has no inverse (a zero scale or spacing?)"));
  // Of the product, as what is far from the world's origin cancels out in it.
  this->View.indexToClip = Inverse(frame.worldToIndex * frame.clipToWorld,
                                   "the camera's and the volume's matrices have no common inverse");
  this->View.unit.worldToMedium = frame.worldToMedium;
  this->View.unit.isWorldMedium =
      ProjectedVoxel::IsNearOne(glm::transpose(frame.worldToMedium) * frame.worldToMedium);
  this->View.unit.length = std::numeric_limits<double>::infinity();
  const glm::dmat3 indexToMedium = frame.worldToMedium * this->View.indexToWorld;
  for (int axis = 0; axis < 3; ++axis) {
    // A single layer of voxels is a slab one spacing thick; else the domain ends at the outer
    // points.
    this->View.low[axis] = dims[axis] == 1 ? -0.5 : 0.0;
    this->View.high[axis] = dims[axis] == 1 ? 0.5 : static_cast<double>(dims[axis] - 1);
    this->View.unit.length = std::min(this->View.unit.length, glm::length(indexToMedium[axis]));
  }
  Inverse(glm::dmat4(frame.worldToMedium), "the medium's matrix has no inverse");
  Require(this->View.unit.length > 0,
          "the volume is flat where lengths of the medium are measured");
  this->View.voxel = VoxelOf(this->View, dims);
  if (frame.cropping) {
    const CroppedBox box = BoxOf(*frame.cropping);
    this->View.low = glm::max(this->View.low, box.low);
    this->View.high = glm::min(this->View.high, box.high);
  }
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
    longest = std::max(
        longest, glm::length(this->View.unit.worldToMedium * (this->View.indexToWorld * diagonal)));
  }
  return longest / this->View.unit.length;
}

Ray RayGeometry::ray(int x, int y) const { return this->View.ray(x, y); }

Ray RayGeometry::ray(int x, int y, int part) const { return this->View.ray(x, y, part); }

Ray RayGeometry::rayThroughPiece(int x, int y) const { return this->View.rayThroughPiece(x, y); }

} // namespace inr
