// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Blending.h"

#include <glm/gtc/type_precision.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <vector>

class vtkImageData;
class vtkMatrix4x4;
class vtkPlaneCollection;
class vtkRenderer;
class vtkVolumeMapper;
class vtkVolumeProperty;

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

/// The image data that stands for an INR and the two grids it is about: the one presented to VTK
/// (of which the image may hold a piece) and the INR's native one, both over the same bounds.
struct PresentedGrid
{
  vtkImageData* image = nullptr;
  glm::ivec3 presented{1};
  glm::ivec3 shift{0}; ///< see vtkINRDataArray::GetShift
  glm::i64vec3 native{1};
};

/// Inverse of what the renderer's camera does, stereo shear and tiles included.
glm::dmat4 ClipToWorld(vtkRenderer* renderer);

/// Presented to native indices; an axis of one point has nothing to scale.
glm::dmat4 PresentedToNative(const PresentedGrid& grid);

/// World space to the native grid's continuous point indices. Presented point i of n stands at
/// native index i*(N-1)/(n-1). `volumeToWorld` is the actor's matrix.
glm::dmat4 WorldToIndex(const PresentedGrid& grid, vtkMatrix4x4* volumeToWorld);

/// Directions in world space to the volume's own, in which VTK measures ScalarOpacityUnitDistance.
glm::dmat3 WorldToVolume(vtkMatrix4x4* volumeToWorld);

/// Half spaces (see Frame::clippingPlanes) of a mapper's planes; null means none.
std::vector<glm::dvec4> ClippingPlanes(vtkPlaneCollection* planes);

/// Of the presented grid what the image holds and no other process, too: all but its ghost cells.
std::array<int, 6> OwnExtent(const PresentedGrid& grid);

/// Half spaces (see Frame::piece) that bound the image's own part, none when that is the whole
/// grid: ranks that hold neighbouring pieces then draw neighbouring parts.
std::vector<glm::dvec4> PiecePlanes(const PresentedGrid& grid, const glm::dmat4& worldToIndex);

/// How a mapper blends, and which isosurfaces; its mode must be one that BlendMode has.
Blending BlendingOf(vtkVolumeMapper* mapper, vtkVolumeProperty* property);

/// Whether less than the whole grid is the image's own.
bool IsPiece(const PresentedGrid& grid);

/// Whether the depth buffer can hold anything: a visible prop with opaque geometry (volumes and
/// overlays have none), or an earlier layer's depth that the renderer keeps.
bool MayHaveOpaqueDepth(vtkRenderer* renderer);

/// Whether something in front of a volume, or in its midst, can be one that nobody selects, such as
/// the highlight of an earlier selection.
bool MayHideByWhatIsNotPicked(vtkRenderer* renderer);

/// Window-space depth of the viewport, row 0 at the bottom, multisampling resolved; empty when VTK
/// cannot read it. The render window must be current.
std::vector<float> ReadOpaqueDepth(vtkRenderer* renderer, const Viewport& viewport);

/// The pixel of the viewport in which the centre of one lies of a smaller image over it, both by
/// number, row by row.
std::size_t PixelUnder(std::size_t pixel, int width, int height, const Viewport& viewport);

/// The depth at the centres of the pixels of a smaller image over the same viewport.
std::vector<float> ReduceDepth(const std::vector<float>& depth, const Viewport& viewport, int width,
                               int height);

} // namespace inr
