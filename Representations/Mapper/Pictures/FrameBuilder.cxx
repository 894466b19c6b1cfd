// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/FrameBuilder.h"

#include "Representations/Mapper/Scene/CroppingRegions.h"
#include "Representations/Mapper/Scene/DrawnGrid.h"
#include "Representations/Mapper/Scene/SceneLights.h"
#include "Representations/Mapper/Scene/Viewport.h"

#include <vtkContourValues.h>
#include <vtkMatrix4x4.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace inr {
namespace {

/// Directions in world space to the volume's own, in which VTK measures ScalarOpacityUnitDistance.
glm::dmat3 WorldToVolume(vtkMatrix4x4* volumeToWorld)
{
  return glm::inverse(glm::dmat3(ToGlm(volumeToWorld)));
}

/// Half spaces (see Frame::clippingPlanes) of a mapper's planes; null means none.
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

/// How a mapper blends, and which isosurfaces; its mode must be one that BlendMode has.
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

} // namespace

Frame MakeFrame(const DrawnGrid& grid, vtkVolumeMapper* mapper, vtkRenderer* renderer,
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
