// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <vector>

class vtkImageData;
class vtkMatrix4x4;

namespace inr {

/// The image data that stands for an INR and the two grids it is about: the one presented to VTK
/// (of which the image may hold a piece) and the INR's native one, both over the same bounds.
struct DrawnGrid
{
  vtkImageData* image = nullptr;
  glm::ivec3 presented{1};
  glm::ivec3 shift{0}; ///< see vtkINRDataArray::GetShift
  glm::i64vec3 native{1};
};

/// Presented to native indices; an axis of one point has nothing to scale.
glm::dmat4 PresentedToNative(const DrawnGrid& grid);

/// World space to the native grid's continuous point indices. Presented point i of n stands at
/// native index i*(N-1)/(n-1). `volumeToWorld` is the actor's matrix.
glm::dmat4 WorldToIndex(const DrawnGrid& grid, vtkMatrix4x4* volumeToWorld);

/// Where these points of the presented grid are, along the volume's axes.
void BoundsOf(const DrawnGrid& grid, const std::array<int, 6>& extent, double bounds[6]);

/// The same of all of them.
void WholeBounds(const DrawnGrid& grid, double bounds[6]);

/// Of the presented grid what the image holds and no other process, too: all but its ghost cells.
std::array<int, 6> OwnExtent(const DrawnGrid& grid);

/// Half spaces (see Frame::piece) that bound the image's own part, none when that is the whole
/// grid: ranks that hold neighbouring pieces then draw neighbouring parts.
std::vector<glm::dvec4> PiecePlanes(const DrawnGrid& grid, const glm::dmat4& worldToIndex);

/// Whether less than the whole grid is the image's own.
bool IsPiece(const DrawnGrid& grid);

} // namespace inr
