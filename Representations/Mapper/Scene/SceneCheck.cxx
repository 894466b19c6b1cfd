// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Scene/SceneCheck.h"

#include "Representations/Mapper/Scene/CroppingRegions.h"

#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkPiecewiseFunction.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolumeMapper.h>
#include <vtkVolumeProperty.h>

namespace inr {
namespace {

/// A gradient opacity function that is 1 everywhere asks for nothing.
bool UsesGradientOpacity(vtkVolumeProperty* property)
{
  if (property->GetDisableGradientOpacity() || !property->HasGradientOpacity()) {
    return false;
  }
  vtkPiecewiseFunction* function = property->GetStoredGradientOpacity();
  double node[4];
  for (int i = 0; i < function->GetSize(); ++i) {
    function->GetNodeValue(i, node);
    if (node[1] != 1.0) {
      return true;
    }
  }
  return false;
}

/// Whether one of an image's points or cells has this flag. Asked in every picture: the bytes in
/// one go take no time that shows, while VTK asks for each value.
bool AnyHas(vtkUnsignedCharArray* flags, int flag)
{
  const vtkIdType count = flags ? flags->GetNumberOfValues() : 0;
  const unsigned char* const values = count > 0 ? flags->GetPointer(0) : nullptr;
  int all = 0;
  for (vtkIdType k = 0; k < count; ++k) {
    all |= values[k];
  }
  return (all & flag) != 0;
}

std::string WhyNotBlended(vtkVolumeMapper* mapper, const DrawnGrid& grid, RenderMode mode,
                          bool together)
{
  const int blend = mapper->GetBlendMode();
  if (blend == vtkVolumeMapper::COMPOSITE_BLEND) {
    return {};
  }
  if (blend < 0 || blend > vtkVolumeMapper::ISOSURFACE_BLEND) {
    return "An INR cannot be drawn with the blend mode slice or one that is none; choose another "
           "one, and for a slice a slice filter.";
  }
  if (mode == RenderMode::PathTracing) {
    return "Path tracing knows no blend mode but composite; set the blend mode to composite or the "
           "render mode to ray marching.";
  }
  return blend != vtkVolumeMapper::ISOSURFACE_BLEND && IsPiece(grid) && !together
             ? "A projection (maximum, minimum, average or additive blending) of an INR "
               "needs the whole volume in one process, and this one has a piece; set the "
               "blend mode to composite."
             : "";
}

} // namespace

std::string WhyRefused(vtkVolumeMapper* mapper, vtkVolumeProperty* property, const DrawnGrid& grid,
                       RenderMode mode, bool together)
{
  vtkImageData* image = grid.image;
  std::string problem = WhyNotBlended(mapper, grid, mode, together);
  if (problem.empty()) {
    problem = WhyNotCropped(grid, mapper);
  }
  if (!problem.empty()) {
    return problem;
  }
  const std::optional<Cropping> cropping = CroppingOf(grid, mapper);
  if (cropping && mode == RenderMode::PathTracing && !BoxOf(*cropping).full) {
    return "Path tracing can crop an INR to a box only; choose cropping regions that make up one, "
           "or ray marching.";
  }
  if (property->GetTransferFunctionMode() == vtkVolumeProperty::TF_2D) {
    return "An INR cannot be drawn with a 2D transfer function; turn \"Edit 2D Transfer Function\" "
           "off in the colour map editor (of a vtkVolumeProperty: SetTransferFunctionModeTo1D).";
  }
  if (UsesGradientOpacity(property)) {
    return "An INR cannot be drawn with gradient opacity; turn gradient opacity off.";
  }
  if (property->GetNumberOfLabels() > 0) {
    return "An INR cannot be drawn with a label mask; remove the label functions from the volume "
           "property.";
  }
  if (AnyHas(image->GetPointGhostArray(), vtkDataSetAttributes::HIDDENPOINT) ||
      AnyHas(image->GetCellGhostArray(), vtkDataSetAttributes::HIDDENCELL)) {
    return "An INR cannot be drawn with blanked points or cells (a mask); remove the blanking.";
  }
  return {};
}

} // namespace inr
