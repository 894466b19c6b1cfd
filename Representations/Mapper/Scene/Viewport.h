// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/mat4x4.hpp>

#include <cstddef>

class vtkMatrix4x4;
class vtkRenderer;

namespace inr {

/// The part of the window that a renderer draws into, in pixels; (x, y) is its lower left corner.
struct Viewport
{
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};
Viewport GetViewport(vtkRenderer* renderer);

/// Inverse of what the renderer's camera does, stereo shear and tiles included.
glm::dmat4 ClipToWorld(vtkRenderer* renderer);

/// Whether the renderer's camera has all that is within these bounds behind it. None of parallel
/// rays has.
bool IsBehindCamera(vtkRenderer* renderer, const double bounds[6]);

/// The pixel of the viewport in which the centre of one lies of a smaller image over it, both by
/// number, row by row.
std::size_t PixelUnder(std::size_t pixel, int width, int height, const Viewport& viewport);

glm::dmat4 ToGlm(vtkMatrix4x4* matrix);

} // namespace inr
