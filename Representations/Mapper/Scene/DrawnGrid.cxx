// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/DrawnGrid.h"

#include "Representations/Mapper/Scene/Viewport.h"

#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

namespace inr {
namespace {

/// Continuous indices of the image to the image's physical space.
glm::dmat4 IndexToPhysical(vtkImageData* image)
{
  glm::dmat4 result(glm::transpose(glm::make_mat3(image->GetDirectionMatrix()->GetData())));
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] *= image->GetSpacing()[axis];
  }
  result[3] = glm::dvec4(glm::make_vec3(image->GetOrigin()), 1.0);
  return result;
}

/// The box of an extent's cells of which the first and the last one have these numbers.
std::array<int, 6> CellBox(const std::array<int, 6>& extent, vtkIdType first, vtkIdType last)
{
  std::array<int, 6> box = extent;
  for (int axis = 0; axis < 3; ++axis) {
    const int low = extent[2 * axis];
    const int cells = extent[2 * axis + 1] - low;
    if (cells > 0) { // not flat
      box[2 * axis] = low + static_cast<int>(first % cells);
      box[2 * axis + 1] = low + static_cast<int>(last % cells) + 1;
      first /= cells;
      last /= cells;
    }
  }
  return box;
}

} // namespace

glm::dmat4 PresentedToNative(const DrawnGrid& grid)
{
  glm::dmat4 result(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.presented[axis] > 1) {
      result[axis][axis] = static_cast<double>(grid.native[axis] - 1) / (grid.presented[axis] - 1);
    }
  }
  return result;
}

glm::dmat4 WorldToIndex(const DrawnGrid& grid, vtkMatrix4x4* volumeToWorld)
{
  const glm::dmat4 indexToWorld = ToGlm(volumeToWorld) * IndexToPhysical(grid.image);
  const glm::dmat4 toPresented = glm::translate(glm::dmat4(1.0), -glm::dvec3(grid.shift));
  return PresentedToNative(grid) * toPresented * glm::inverse(indexToWorld);
}

void BoundsOf(const DrawnGrid& grid, const std::array<int, 6>& extent, double bounds[6])
{
  std::array<int, 6> shifted;
  for (int k = 0; k < 6; ++k) {
    shifted[k] = extent[k] + grid.shift[k / 2];
  }
  vtkNew<vtkImageData> box; // CopyStructure would look at all ghost cells
  box->SetOrigin(grid.image->GetOrigin());
  box->SetSpacing(grid.image->GetSpacing());
  box->SetDirectionMatrix(grid.image->GetDirectionMatrix());
  box->SetExtent(shifted.data());
  box->GetBounds(bounds);
}

void WholeBounds(const DrawnGrid& grid, double bounds[6])
{
  const glm::ivec3 last = grid.presented - 1;
  BoundsOf(grid, {0, last.x, 0, last.y, 0, last.z}, bounds);
}

std::array<int, 6> OwnExtent(const DrawnGrid& grid)
{
  std::array<int, 6> extent;
  for (int k = 0; k < 6; ++k) {
    extent[k] = grid.image->GetExtent()[k] - grid.shift[k / 2];
  }
  vtkUnsignedCharArray* ghosts = grid.image->GetCellGhostArray();
  const vtkIdType count = ghosts ? grid.image->GetNumberOfCells() : 0;
  if (count == 0 || ghosts->GetNumberOfTuples() != count) {
    return extent;
  }
  const auto isOwn = [&](vtkIdType cell) {
    return (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) == 0;
  };
  vtkIdType first = 0;
  while (first < count && !isOwn(first)) {
    ++first;
  }
  if (first == count) {
    return {extent[0], extent[0], extent[2], extent[2], extent[4], extent[4]};
  }
  vtkIdType last = count - 1;
  while (!isOwn(last)) {
    --last;
  }
  return CellBox(extent, first, last); // the pipeline cuts images into boxes
}

std::vector<glm::dvec4> PiecePlanes(const DrawnGrid& grid, const glm::dmat4& worldToIndex)
{
  std::vector<glm::dvec4> result;
  const glm::dmat4 toNative = PresentedToNative(grid);
  const std::array<int, 6> extent = OwnExtent(grid);
  for (int axis = 0; axis < 3; ++axis) {
    // A plane maps by the transpose of the matrix that maps points the other way.
    const glm::dvec4 along = glm::row(worldToIndex, axis);
    if (extent[2 * axis] > 0) {
      const double low = extent[2 * axis] * toNative[axis][axis];
      result.push_back(along - glm::dvec4(0, 0, 0, low));
    }
    if (extent[2 * axis + 1] < grid.presented[axis] - 1) {
      const double high = extent[2 * axis + 1] * toNative[axis][axis];
      result.push_back(glm::dvec4(0, 0, 0, high) - along);
    }
  }
  return result;
}

bool IsPiece(const DrawnGrid& grid)
{
  const std::array<int, 6> extent = OwnExtent(grid);
  for (int axis = 0; axis < 3; ++axis) {
    if (extent[2 * axis] > 0 || extent[2 * axis + 1] < grid.presented[axis] - 1) {
      return true;
    }
  }
  return false;
}

} // namespace inr
