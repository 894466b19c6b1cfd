// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

class vtkDataArray;
class vtkImageData;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace inr {

/// Why a scene that asks for this cannot be drawn, with what to do about it; empty when it can.
/// What this mapper lacks is refused, never drawn as if it had not been asked for.
std::string WhyRefused(vtkVolumeMapper* mapper, vtkVolumeProperty* property, vtkImageData* image);

} // namespace inr
