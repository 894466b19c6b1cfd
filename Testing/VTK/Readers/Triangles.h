// SPDX-License-Identifier: BSD-3-Clause
//
// What a surface's triangles are, however its points are numbered.
#pragma once

#include <vtkDataArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

/// A triangle by its corners' places, with the lowest first: what does not depend on numbering.
using Triangle = std::array<glm::vec3, 3>;

struct LessPlace
{
  bool operator()(const glm::vec3& a, const glm::vec3& b) const
  {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  }
  bool operator()(const Triangle& a, const Triangle& b) const
  {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), LessPlace());
  }
};

inline glm::vec3 PlaceOf(vtkPolyData* surface, vtkIdType point)
{
  glm::dvec3 place;
  surface->GetPoint(point, &place.x);
  return place;
}

inline std::vector<Triangle> TrianglesOf(vtkPolyData* surface)
{
  std::vector<Triangle> triangles;
  vtkNew<vtkIdList> ids;
  for (vtkIdType k = 0; k < surface->GetNumberOfCells(); ++k) {
    surface->GetCellPoints(k, ids);
    Triangle triangle;
    for (int corner = 0; corner < 3; ++corner) {
      triangle[static_cast<std::size_t>(corner)] = PlaceOf(surface, ids->GetId(corner));
    }
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end(), LessPlace()),
                triangle.end());
    triangles.push_back(triangle);
  }
  std::sort(triangles.begin(), triangles.end(), LessPlace());
  return triangles;
}

/// Edges that belong to one triangle only.
inline int OpenEdges(vtkPolyData* surface)
{
  std::map<std::pair<vtkIdType, vtkIdType>, int> uses;
  vtkNew<vtkIdList> ids;
  for (vtkIdType k = 0; k < surface->GetNumberOfCells(); ++k) {
    surface->GetCellPoints(k, ids);
    for (int corner = 0; corner < 3; ++corner) {
      const auto edge = std::minmax({ids->GetId(corner), ids->GetId((corner + 1) % 3)});
      ++uses[{edge.first, edge.second}];
    }
  }
  return static_cast<int>(
      std::count_if(uses.begin(), uses.end(), [](const auto& use) { return use.second == 1; }));
}

/// The part of a surface's triangles whose corners go round counter-clockwise as seen from where
/// their normals point to.
inline double PartThatFacesItsNormals(vtkPolyData* surface)
{
  vtkDataArray* normals = surface->GetPointData()->GetNormals();
  vtkIdType facing = 0;
  vtkIdType others = 0; // than those whose corners fall together
  for (vtkIdType cell = 0; cell < surface->GetNumberOfCells(); ++cell) {
    vtkNew<vtkIdList> ids;
    surface->GetCellPoints(cell, ids);
    glm::dvec3 corner[3], along(0.0);
    for (int k = 0; k < 3; ++k) {
      surface->GetPoint(ids->GetId(k), &corner[k].x);
      glm::dvec3 normal;
      normals->GetTuple(ids->GetId(k), &normal.x);
      along += normal;
    }
    const glm::dvec3 face = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    if (glm::length(face) > 0) {
      ++others;
      facing += glm::dot(face, along) > 0 ? 1 : 0;
    }
  }
  return static_cast<double>(facing) / static_cast<double>(others);
}
