// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/GridBox.h"
#include "Readers/Contour/ContourBricks.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

/// The part of an isosurface that lies in one brick.
struct SurfacePatch
{
  struct Vertex
  {
    std::uint64_t edge; ///< of the level's grid that the vertex lies on; the same in every brick
    bool shared;        ///< on a face of the brick, so that the next brick may have it, too
    glm::dvec3 place;   ///< in voxels of the level
    glm::vec3 gradient; ///< of the values, in units per voxel of the level; where asked for
  };
  std::vector<Vertex> vertices;
  std::vector<std::int32_t> triangles; ///< three vertices each
  /// Whether the surface reaches the face at the low (2 * axis) and high end of an axis.
  bool reaches[6] = {};
};

/// Voxels of a brick in data units, with a layer of those around it, where the level has such, when
/// gradients are wanted.
class BrickContour
{
public:
  /// `brick` of a level of `size` voxels. Gradients are wanted in parts of `unit`, for which single
  /// precision has to suffice: 0 = not at all.
  BrickContour(const inr::GridBox& brick, const glm::i64vec3& size, double unit);

  /// The voxels to set `values` to, x fastest.
  const inr::GridBox& GetBox() const { return this->Box; }
  std::vector<double> values;

  /// Marching cubes (Lorensen and Cline, SIGGRAPH 1987) with VTK's cases: a vertex on every edge of
  /// the grid between a value below `value` and one that is not, interpolated linearly.
  SurfacePatch Contour(double value);

private:
  glm::dvec3 Gradient(const glm::i64vec3& voxel) const;
  std::int32_t VertexOn(SurfacePatch& patch, double value, const glm::i64vec3& cell, int edge);
  void AddCell(SurfacePatch& patch, double value, const glm::i64vec3& cell);
  void FindReached(SurfacePatch& patch, double value) const;

  double At(const glm::i64vec3& voxel) const
  {
    return this->values[static_cast<std::size_t>(
        inr::GridNumber(voxel - this->Box.first, this->Box.size))];
  }

  inr::GridBox Brick;
  inr::GridBox Box;
  glm::i64vec3 Size;
  double Unit;
  std::vector<std::int32_t> VertexOfEdge; ///< -1 where there is none yet
};
