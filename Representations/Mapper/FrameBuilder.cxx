// SPDX-License-Identifier: BSD-3-Clause
#include "FrameBuilder.h"

#include <vtkActor2D.h>
#include <vtkCamera.h>
#include <vtkContourValues.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPropCollection.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace inr {
namespace {

glm::dmat4 ToGlm(vtkMatrix4x4* matrix)
{
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      result[column][row] = matrix->GetElement(row, column);
    }
  }
  return result;
}

/// Continuous indices of the image to the image's physical space.
glm::dmat4 IndexToPhysical(vtkImageData* image)
{
  glm::dmat4 result(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      result[column][row] =
          image->GetDirectionMatrix()->GetElement(row, column) * image->GetSpacing()[column];
    }
    result[3][row] = image->GetOrigin()[row];
  }
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

bool DrawsOpaque(vtkProp* prop)
{
  return prop->GetVisibility() && !vtkVolume::SafeDownCast(prop) &&
         !vtkActor2D::SafeDownCast(prop) && prop->HasOpaqueGeometry();
}

template <class Test> bool AnyProp(vtkRenderer* renderer, const Test& test)
{
  vtkCollectionSimpleIterator iterator;
  vtkPropCollection* props = renderer->GetViewProps();
  props->InitTraversal(iterator);
  while (vtkProp* prop = props->GetNextProp(iterator)) {
    if (test(prop)) {
      return true;
    }
  }
  return false;
}

} // namespace

Viewport GetViewport(vtkRenderer* renderer)
{
  Viewport result;
  renderer->GetTiledSizeAndOrigin(&result.width, &result.height, &result.x, &result.y);
  return result;
}

glm::dmat4 ClipToWorld(vtkRenderer* renderer)
{
  // Not GetCompositeProjectionTransformMatrix: that one is for picking and leaves out stereo.
  vtkCamera* camera = renderer->GetActiveCamera();
  const glm::dmat4 projection =
      ToGlm(camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1));
  return glm::inverse(projection * ToGlm(camera->GetModelViewTransformMatrix()));
}

glm::dmat4 PresentedToNative(const PresentedGrid& grid)
{
  glm::dmat4 result(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    if (grid.presented[axis] > 1) {
      result[axis][axis] = static_cast<double>(grid.native[axis] - 1) / (grid.presented[axis] - 1);
    }
  }
  return result;
}

glm::dmat4 WorldToIndex(const PresentedGrid& grid, vtkMatrix4x4* volumeToWorld)
{
  const glm::dmat4 indexToWorld = ToGlm(volumeToWorld) * IndexToPhysical(grid.image);
  const glm::dmat4 toPresented = glm::translate(glm::dmat4(1.0), -glm::dvec3(grid.shift));
  return PresentedToNative(grid) * toPresented * glm::inverse(indexToWorld);
}

glm::dmat3 WorldToVolume(vtkMatrix4x4* volumeToWorld)
{
  return glm::inverse(glm::dmat3(ToGlm(volumeToWorld)));
}

std::vector<glm::dvec4> ClippingPlanes(vtkPlaneCollection* planes)
{
  std::vector<glm::dvec4> result;
  for (int i = 0; planes && i < planes->GetNumberOfItems(); ++i) {
    const double* n = planes->GetItem(i)->GetNormal();
    const double* o = planes->GetItem(i)->GetOrigin();
    const glm::dvec3 normal(n[0], n[1], n[2]);
    result.emplace_back(normal, -glm::dot(normal, glm::dvec3(o[0], o[1], o[2])));
  }
  return result;
}

std::array<int, 6> OwnExtent(const PresentedGrid& grid)
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

std::vector<glm::dvec4> PiecePlanes(const PresentedGrid& grid, const glm::dmat4& worldToIndex)
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

Blending BlendingOf(vtkVolumeMapper* mapper, vtkVolumeProperty* property)
{
  Blending blending;
  switch (mapper->GetBlendMode()) {
  case vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND:
    blending.mode = BlendMode::MaximumIntensity;
    break;
  case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
    blending.mode = BlendMode::MinimumIntensity;
    break;
  case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
    blending.mode = BlendMode::AverageIntensity;
    blending.averageLow = mapper->GetAverageIPScalarRange()[0];
    blending.averageHigh = mapper->GetAverageIPScalarRange()[1];
    break;
  case vtkVolumeMapper::ADDITIVE_BLEND:
    blending.mode = BlendMode::Additive;
    break;
  case vtkVolumeMapper::ISOSURFACE_BLEND: {
    blending.mode = BlendMode::Isosurface;
    vtkContourValues* values = property->GetIsoSurfaceValues();
    for (int k = 0; k < values->GetNumberOfContours(); ++k) {
      blending.isosurfaces.push_back(values->GetValue(k));
    }
    break;
  }
  default:
    break;
  }
  return blending;
}

bool IsPiece(const PresentedGrid& grid)
{
  const std::array<int, 6> extent = OwnExtent(grid);
  for (int axis = 0; axis < 3; ++axis) {
    if (extent[2 * axis] > 0 || extent[2 * axis + 1] < grid.presented[axis] - 1) {
      return true;
    }
  }
  return false;
}

bool MayHaveOpaqueDepth(vtkRenderer* renderer)
{
  return renderer->GetPreserveDepthBuffer() || AnyProp(renderer, DrawsOpaque);
}

bool MayHideByWhatIsNotPicked(vtkRenderer* renderer)
{
  return AnyProp(renderer, [](vtkProp* prop) { return !prop->GetPickable() && DrawsOpaque(prop); });
}

std::vector<float> ReadOpaqueDepth(vtkRenderer* renderer, const Viewport& viewport)
{
  std::vector<float> depth(static_cast<std::size_t>(viewport.width) * viewport.height);
  const int ok = renderer->GetRenderWindow()->GetZbufferData(
      viewport.x, viewport.y, viewport.x + viewport.width - 1, viewport.y + viewport.height - 1,
      depth.data());
  return ok ? depth : std::vector<float>();
}

std::size_t PixelUnder(std::size_t pixel, int width, int height, const Viewport& viewport)
{
  const auto across = static_cast<std::size_t>(width);
  const double x = static_cast<double>(pixel % across) + 0.5;
  const double y = static_cast<double>(pixel / across) + 0.5;
  const auto row = static_cast<std::size_t>(y * viewport.height / height);
  return row * viewport.width + static_cast<std::size_t>(x * viewport.width / width);
}

std::vector<float> ReduceDepth(const std::vector<float>& depth, const Viewport& viewport, int width,
                               int height)
{
  std::vector<float> result(static_cast<std::size_t>(width) * height);
  for (std::size_t pixel = 0; pixel < result.size(); ++pixel) {
    result[pixel] = depth[PixelUnder(pixel, width, height, viewport)];
  }
  return result;
}

} // namespace inr
