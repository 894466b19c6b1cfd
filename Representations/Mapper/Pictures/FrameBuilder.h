// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"
#include "Representations/Mapper/Pictures/PaintSettings.h"
#include "Representations/Mapper/Scene/DrawnGrid.h"

class vtkRenderer;
class vtkVolume;
class vtkVolumeMapper;

namespace inr {

/// What a renderer shows of a volume, but for the picture's size, its time, and what else there is
/// to be seen.
Frame MakeFrame(const DrawnGrid& grid, vtkVolumeMapper* mapper, vtkRenderer* renderer,
                vtkVolume* volume, const PaintSettings& settings);

} // namespace inr
