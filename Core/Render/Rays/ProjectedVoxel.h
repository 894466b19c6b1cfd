// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace inr {

/// How large a volume's voxels look from some direction. Plain data.
///
/// The places that are one voxel from a given one, where voxels are counted as unit lengths, make
/// an ellipsoid, whose half axes are the voxel's edges where these are at right angles. Its shadow
/// along a direction is an ellipse, and the longer half axis of that is the voxel's size: the edge
/// of a cube from wherever it is seen, and of thick slices the edge within a slice where they are
/// seen from above, their thickness from the side. Of skewed ones it may be short, but is taken for
/// the shortest edge at least.
class ProjectedVoxel
{
public:
  ProjectedVoxel() = default; ///< a unit cube
  /// `edges`: vectors from a voxel to the next along each axis, 0 along axes of a single voxel.
  /// `shortest`: the length of the shortest one, which no size is below; above 0.
  INR_HOST_DEVICE ProjectedVoxel(const glm::dmat3& edges, double shortest) : Shortest(shortest)
  {
    const glm::dmat3 scaled = edges / shortest; // a square of what a spacing may be leaves double
    const glm::dmat3 squares = scaled * glm::transpose(scaled);
    this->Squares = squares;
    this->Adjugate =
        glm::dmat3(glm::cross(squares[1], squares[2]), glm::cross(squares[2], squares[0]),
                   glm::cross(squares[0], squares[1]));
    this->Trace = squares[0][0] + squares[1][1] + squares[2][2];
    this->IsCube = IsNearOne(squares);
  }

  /// Whether a matrix is the unit matrix, but for rounding.
  INR_HOST_DEVICE static bool IsNearOne(const glm::dmat3& matrix)
  {
    constexpr double rounding = 1e-9;
    bool isNear = true;
    for (int k = 0; k < 9; ++k) {
      const double one = k / 3 == k % 3 ? 1.0 : 0.0;
      isNear = isNear && std::abs(matrix[k / 3][k % 3] - one) <= rounding;
    }
    return isNear;
  }

  /// Its size seen along a unit vector. The root of the larger eigenvalue of edges * edges^T,
  /// restricted to the plane across the vector: of that, trace and determinant are simple.
  INR_HOST_DEVICE double across(const glm::dvec3& direction) const
  {
    if (this->IsCube) { // of which most volumes are made
      return this->Shortest;
    }
    const double trace = this->Trace - glm::dot(direction, this->Squares * direction);
    const double determinant = glm::dot(direction, this->Adjugate * direction);
    const double root = std::sqrt(glm::max(trace * trace - 4.0 * determinant, 0.0));
    return this->Shortest * std::sqrt(glm::max(0.5 * (trace + root), 1.0));
  }

  /// What it is at least, seen along any.
  INR_HOST_DEVICE double least() const { return this->Shortest; }

private:
  glm::dmat3 Squares{1.0};
  glm::dmat3 Adjugate{1.0};
  double Trace = 3;
  double Shortest = 1;
  bool IsCube = true;
};

} // namespace inr
