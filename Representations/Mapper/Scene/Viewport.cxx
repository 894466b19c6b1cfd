// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/Viewport.h"

#include <vtkBoundingBox.h>
#include <vtkCamera.h>
#include <vtkMatrix4x4.h>
#include <vtkRenderer.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace inr {

glm::dmat4 ToGlm(vtkMatrix4x4* matrix)
{
  return glm::transpose(glm::make_mat4(matrix->GetData())); // of rows; glm keeps columns
}

Viewport GetViewport(vtkRenderer* renderer)
{
  Viewport result;
  renderer->GetTiledSizeAndOrigin(&result.width, &result.height, &result.x, &result.y);
  return result;
}

namespace {

glm::dmat4 WorldToClip(vtkRenderer* renderer)
{
  // Not GetCompositeProjectionTransformMatrix: that one is for picking and leaves out stereo.
  vtkCamera* camera = renderer->GetActiveCamera();
  const glm::dmat4 projection =
      ToGlm(camera->GetProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1, 1));
  return projection * ToGlm(camera->GetModelViewTransformMatrix());
}

} // namespace

glm::dmat4 ClipToWorld(vtkRenderer* renderer) { return glm::inverse(WorldToClip(renderer)); }

bool IsBehindCamera(vtkRenderer* renderer, const double bounds[6])
{
  const glm::dmat4 toClip = WorldToClip(renderer);
  const vtkBoundingBox box(bounds);
  bool behind = true;
  for (int corner = 0; behind && corner < 8; ++corner) {
    glm::dvec4 at(1.0);
    box.GetCorner(corner, glm::value_ptr(at));
    behind = (toClip * at).w < 0; // always 1 of parallel rays
  }
  return behind;
}

std::size_t PixelUnder(std::size_t pixel, int width, int height, const Viewport& viewport)
{
  const auto across = static_cast<std::size_t>(width);
  const double x = static_cast<double>(pixel % across) + 0.5;
  const std::size_t whole = pixel / across;
  const double y = static_cast<double>(whole) + 0.5;
  const auto row = static_cast<std::size_t>(y * viewport.height / height);
  return row * viewport.width + static_cast<std::size_t>(x * viewport.width / width);
}

} // namespace inr
