// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Readers/Contour/BrickContour.h"
#include "Readers/Grid/NativeGrid.h"

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

class vtkDataArray;
class vtkDoubleArray;
class vtkFloatArray;
class vtkIdTypeArray;
class vtkPolyData;

/// Joins patches of isosurfaces: what lies on a face of a brick becomes one vertex of both sides.
class SurfaceBuilder
{
public:
  /// For patches of `level`; `surfaces` is the number of isovalues. Points are double where float
  /// would miss a thousandth of a voxel.
  SurfaceBuilder(const NativeGrid& grid, int level, std::size_t surfaces, bool normals);
  ~SurfaceBuilder();
  SurfaceBuilder(const SurfaceBuilder&) = delete;
  SurfaceBuilder& operator=(const SurfaceBuilder&) = delete;

  /// A patch of isosurface number `surface` at `value`. Throws std::bad_alloc.
  void Add(std::size_t surface, double value, const SurfacePatch& patch);

  /// What the surface takes so far, this builder's own tables included.
  double GetBytes() const;
  vtkIdType GetNumberOfTriangles() const;

  /// Hands the surface over; its points have the isovalues in an array with the volume's name.
  void Finish(vtkPolyData* output);

private:
  using Vertices = std::vector<const SurfacePatch::Vertex*>;
  void Append(const Vertices& vertices, double value);
  template <class T> void AppendPlaces(const Vertices& vertices, T* out) const;

  std::string ArrayName;
  glm::dvec3 Origin; ///< where voxel 0 of the level stands
  glm::dmat3 Axes;   ///< from one voxel of the level to the next
  glm::dmat3 GradientAxes;
  bool Mirrors; ///< whether the axes are left-handed
  vtkSmartPointer<vtkDataArray> Points;
  vtkSmartPointer<vtkFloatArray> Normals; ///< null where nobody wants them
  vtkNew<vtkDoubleArray> Values;
  vtkNew<vtkIdTypeArray> Triangles;
  std::vector<std::unordered_map<std::uint64_t, std::int64_t>> Shared; ///< by surface
};
