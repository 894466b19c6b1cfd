// SPDX-License-Identifier: BSD-3-Clause
#include "Readers/Contour/SurfaceBuilder.h"

#include "Readers/Common/MemoryCheck.h"
#include "Readers/Common/VTKCompat.h"

#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace {

/// A node of the table of shared vertices, with its bucket and what the allocator adds.
constexpr double BytesPerShared = 56;

/// Room for `count` more values at the end; VTK grows by doubling.
template <class Array> auto* Grow(Array* array, vtkIdType count)
{
  const vtkIdType needed = array->GetNumberOfValues() + count;
  if (const vtkIdType capacity = CapacityOf(*array); needed > capacity) {
    RequireRoom(static_cast<std::size_t>(capacity + needed) * sizeof(typename Array::ValueType));
  }
  auto* room = array->WritePointer(array->GetNumberOfValues(), count);
  if (!room) {
    throw std::bad_alloc();
  }
  return room;
}

bool AreLeftHanded(const glm::dmat3& axes)
{
  glm::dmat3 scaled; // or products of small or large ones are 0 or infinite
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 sizes = glm::abs(axes[axis]);
    scaled[axis] = axes[axis] / std::max({sizes.x, sizes.y, sizes.z});
  }
  return glm::determinant(scaled) < 0;
}

bool NeedsDouble(const glm::dvec3& origin, const glm::dmat3& axes, const glm::i64vec3& size)
{
  double farthest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 index(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 place = origin + axes * (index * glm::dvec3(size));
    farthest = std::max({farthest, std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)});
  }
  const double voxel = std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  return farthest * std::numeric_limits<float>::epsilon() > 1e-3 * voxel;
}

template <class T> T* WriteTuple(const glm::dvec3& tuple, T* out)
{
  return std::transform(&tuple.x, &tuple.x + 3, out, [](double x) { return static_cast<T>(x); });
}

} // namespace

SurfaceBuilder::SurfaceBuilder(const NativeGrid& grid, int level, std::size_t surfaces,
                               bool normals)
    : ArrayName(grid.arrayName), Axes(grid.Axes()), Mirrors(AreLeftHanded(this->Axes)),
      Shared(surfaces)
{
  const LevelGrid own(grid, level);
  this->Origin = own.origin;
  for (int axis = 0; axis < 3; ++axis) {
    this->Axes[axis] *= own.growth[axis];
  }
  this->GradientAxes = glm::transpose(glm::inverse(this->Axes));
  if (NeedsDouble(this->Origin, this->Axes, own.dims)) {
    this->Points = vtkSmartPointer<vtkDoubleArray>::New();
  } else {
    this->Points = vtkSmartPointer<vtkFloatArray>::New();
  }
  this->Points->SetNumberOfComponents(3);
  if (normals) {
    this->Normals = vtkSmartPointer<vtkFloatArray>::New();
    this->Normals->SetNumberOfComponents(3);
    this->Normals->SetName("Normals");
  }
}

SurfaceBuilder::~SurfaceBuilder() = default;

void SurfaceBuilder::Add(std::size_t surface, double value, const SurfacePatch& patch)
{
  if (patch.triangles.empty()) {
    return; // VTK has no room of size 0
  }
  const std::int64_t first = this->Values->GetNumberOfValues();
  Vertices added;
  std::vector<std::int64_t> ids;
  for (const SurfacePatch::Vertex& vertex : patch.vertices) {
    const std::int64_t next = first + static_cast<std::int64_t>(added.size());
    const bool isNew = !vertex.shared || this->Shared[surface].emplace(vertex.edge, next).second;
    ids.push_back(isNew ? next : this->Shared[surface].at(vertex.edge));
    if (isNew) {
      added.push_back(&vertex);
    }
  }
  if (!added.empty()) {
    this->Append(added, value);
  }
  vtkIdType* corners = Grow(this->Triangles.Get(), static_cast<vtkIdType>(patch.triangles.size()));
  // Counter-clockwise as seen from smaller values; axes that mirror turn that round.
  const std::size_t second = this->Mirrors ? 2 : 1;
  for (std::size_t first = 0; first < patch.triangles.size(); first += 3) {
    for (const std::size_t corner : {std::size_t{0}, second, 3 - second}) {
      *corners++ = ids[static_cast<std::size_t>(patch.triangles[first + corner])];
    }
  }
}

void SurfaceBuilder::Append(const Vertices& vertices, double value)
{
  const auto count = static_cast<vtkIdType>(vertices.size());
  if (auto* floats = vtkFloatArray::SafeDownCast(this->Points)) {
    this->AppendPlaces(vertices, Grow(floats, 3 * count));
  } else {
    this->AppendPlaces(vertices, Grow(vtkDoubleArray::SafeDownCast(this->Points), 3 * count));
  }
  std::fill_n(Grow(this->Values.Get(), count), count, value);
  if (this->Normals) {
    float* out = Grow(this->Normals.Get(), 3 * count);
    for (const SurfacePatch::Vertex* vertex : vertices) {
      // Towards smaller values, as VTK's contour filters have it.
      const glm::dvec3 normal = -(this->GradientAxes * glm::dvec3(vertex->gradient));
      const double length = glm::length(normal);
      out = WriteTuple(length > 0 ? normal / length : normal, out);
    }
  }
}

template <class T> void SurfaceBuilder::AppendPlaces(const Vertices& vertices, T* out) const
{
  for (const SurfacePatch::Vertex* vertex : vertices) {
    out = WriteTuple(this->Origin + this->Axes * vertex->place, out);
  }
}

double SurfaceBuilder::GetBytes() const
{
  const auto vertices = static_cast<double>(this->Values->GetNumberOfValues());
  double bytes = vertices * (3.0 * this->Points->GetDataTypeSize() + (this->Normals ? 12 : 0) + 8);
  bytes += static_cast<double>(this->GetNumberOfTriangles()) * 4 * sizeof(vtkIdType);
  for (const auto& table : this->Shared) {
    bytes += BytesPerShared * static_cast<double>(table.size());
  }
  return bytes;
}

vtkIdType SurfaceBuilder::GetNumberOfTriangles() const
{
  return this->Triangles->GetNumberOfValues() / 3;
}

void SurfaceBuilder::Finish(vtkPolyData* output)
{
  vtkNew<vtkIdTypeArray> offsets;
  RequireRoom(static_cast<std::size_t>(this->GetNumberOfTriangles() + 1) * sizeof(vtkIdType));
  offsets->SetNumberOfValues(this->GetNumberOfTriangles() + 1);
  for (vtkIdType k = 0; k < offsets->GetNumberOfValues(); ++k) {
    *offsets->GetPointer(k) = 3 * k;
  }
  vtkNew<vtkCellArray> triangles;
  triangles->SetData(offsets, this->Triangles);
  vtkNew<vtkPoints> points;
  points->SetData(this->Points);
  output->SetPoints(points);
  output->SetPolys(triangles);
  this->Values->SetName(this->ArrayName.c_str());
  output->GetPointData()->SetScalars(this->Values);
  if (this->Normals) {
    output->GetPointData()->SetNormals(this->Normals);
  }
}
