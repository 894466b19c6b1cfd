// SPDX-License-Identifier: BSD-3-Clause
#include "SceneFrame.h"

#include "CroppingRegions.h"
#include "SceneLights.h"

#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

namespace inr {

Frame MakeFrame(const PresentedGrid& grid, vtkVolumeMapper* mapper, vtkRenderer* renderer,
                vtkVolume* volume, const PaintSettings& settings)
{
  Frame frame;
  frame.clipToWorld = ClipToWorld(renderer);
  frame.worldToIndex = WorldToIndex(grid, volume->GetMatrix());
  frame.worldToMedium = WorldToVolume(volume->GetMatrix());
  frame.clippingPlanes = ClippingPlanes(mapper->GetClippingPlanes());
  if (settings.group.isAlone()) {
    frame.piece = PiecePlanes(grid, frame.worldToIndex);
  }
  frame.lights = SceneLights(renderer);
  frame.shading = MaterialOf(volume->GetProperty());
  frame.unitDistance = volume->GetProperty()->GetScalarOpacityUnitDistance();
  frame.mode = settings.mode;
  frame.blending = BlendingOf(mapper, volume->GetProperty());
  frame.cropping = CroppingOf(grid, mapper);
  frame.paths = settings.paths;
  frame.samplesPerPixel = settings.samplesPerPixel;
  frame.sampleDistance = settings.sampleDistance;
  frame.adaptiveSampling = settings.adaptiveSampling;
  frame.preIntegration = settings.preIntegration;
  frame.levelOfDetailScale = settings.levelOfDetailScale;
  frame.errorTolerance = settings.errorTolerance;
  frame.seed = settings.seed;
  return frame;
}

} // namespace inr
