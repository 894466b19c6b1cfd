// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Contour/BrickContour.h"

#include "Core/GridBox.h"
#include "Readers/Common/VTKCompat.h"

#include <glm/common.hpp>

namespace {

/// The corners of a cell as VTK's cases number them.
constexpr int Corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

/// And its edges: the lower end and the axis.
struct CellEdge
{
  int corner;
  int axis;
};
constexpr CellEdge Edges[12] = {{0, 0}, {1, 1}, {3, 0}, {0, 1}, {4, 0}, {5, 1},
                                {7, 0}, {4, 1}, {0, 2}, {1, 2}, {3, 2}, {2, 2}};

glm::i64vec3 CornerOf(const glm::i64vec3& cell, int corner)
{
  return cell + glm::i64vec3(Corners[corner][0], Corners[corner][1], Corners[corner][2]);
}

} // namespace

BrickContour::BrickContour(const inr::GridBox& brick, const glm::i64vec3& size, double unit)
    : Brick(brick), Box(brick), Size(size), Unit(unit)
{
  if (unit > 0) {
    this->Box.first = glm::max(brick.first - std::int64_t{1}, glm::i64vec3(0));
    this->Box.size = glm::min(brick.first + brick.size + std::int64_t{1}, size) - this->Box.first;
  }
}

SurfacePatch BrickContour::Contour(double value)
{
  SurfacePatch patch;
  const glm::i64vec3& size = this->Brick.size;
  this->VertexOfEdge.assign(static_cast<std::size_t>(3 * size.x * size.y * size.z), -1);
  for (std::int64_t z = 0; z + 1 < size.z; ++z) {
    for (std::int64_t y = 0; y + 1 < size.y; ++y) {
      for (std::int64_t x = 0; x + 1 < size.x; ++x) {
        this->AddCell(patch, value, this->Brick.first + glm::i64vec3(x, y, z));
      }
    }
  }
  this->FindReached(patch, value);
  return patch;
}

void BrickContour::AddCell(SurfacePatch& patch, double value, const glm::i64vec3& cell)
{
  int inside = 0;
  for (int corner = 0; corner < 8; ++corner) {
    inside |= this->At(CornerOf(cell, corner)) >= value ? 1 << corner : 0;
  }
  if (inside == 0 || inside == 255) {
    return;
  }
  for (const int* edge = ContourEdges(inside); *edge >= 0; ++edge) {
    patch.triangles.push_back(this->VertexOn(patch, value, cell, *edge));
  }
}

std::int32_t BrickContour::VertexOn(SurfacePatch& patch, double value, const glm::i64vec3& cell,
                                    int edge)
{
  const int axis = Edges[edge].axis;
  const glm::i64vec3 from = CornerOf(cell, Edges[edge].corner);
  const glm::i64vec3 local = from - this->Brick.first;
  const glm::i64vec3& size = this->Brick.size;
  std::int32_t& known = this->VertexOfEdge[static_cast<std::size_t>(
      3 * (local.x + size.x * (local.y + size.y * local.z)) + axis)];
  if (known >= 0) {
    return known;
  }
  glm::i64vec3 to = from;
  ++to[axis];
  const double start = this->At(from);
  const double t = (value - start) / (this->At(to) - start);
  SurfacePatch::Vertex vertex{};
  vertex.edge = static_cast<std::uint64_t>(
      3 * (from.x + this->Size.x * (from.y + this->Size.y * from.z)) + axis);
  vertex.place = from;
  vertex.place[axis] += t;
  for (int other = 0; other < 3; ++other) {
    vertex.shared |= other != axis && (local[other] == 0 || local[other] == size[other] - 1);
  }
  if (this->Unit > 0) {
    vertex.gradient = glm::mix(this->Gradient(from), this->Gradient(to), t);
  }
  known = static_cast<std::int32_t>(patch.vertices.size());
  patch.vertices.push_back(vertex);
  return known;
}

/// Central differences, one-sided at the faces of the volume.
glm::dvec3 BrickContour::Gradient(const glm::i64vec3& voxel) const
{
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    glm::i64vec3 before = voxel;
    glm::i64vec3 after = voxel;
    before[axis] -= voxel[axis] > 0 ? 1 : 0;
    after[axis] += voxel[axis] + 1 < this->Size[axis] ? 1 : 0;
    gradient[axis] = (this->At(after) - this->At(before)) / this->Unit /
                     static_cast<double>(after[axis] - before[axis]);
  }
  return gradient;
}

/// A face with voxels on both sides of the surface has some of it.
void BrickContour::FindReached(SurfacePatch& patch, double value) const
{
  for (int face = 0; face < 6 && !patch.triangles.empty(); ++face) {
    const int axis = face / 2;
    const std::int64_t layer = face % 2 == 0 ? 0 : this->Brick.size[axis] - 1;
    glm::i64vec3 size = this->Brick.size;
    size[axis] = 1;
    bool below = false;
    bool above = false;
    for (std::int64_t k = 0; k < inr::GridCount(size); ++k) {
      glm::i64vec3 local = inr::GridPlace(k, size);
      local[axis] = layer;
      const bool inside = this->At(this->Brick.first + local) >= value;
      below = below || !inside;
      above = above || inside;
    }
    patch.reaches[face] = below && above;
  }
}
