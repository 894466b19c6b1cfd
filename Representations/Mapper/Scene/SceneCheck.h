// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"
#include "Representations/Mapper/Scene/DrawnGrid.h"

#include <string>

class vtkVolumeMapper;
class vtkVolumeProperty;

namespace inr {

/// Why a scene that asks for this cannot be drawn, with what to do about it; empty when it can.
/// What this mapper lacks is refused, never drawn as if it had not been asked for. `together`: with
/// processes that have the other pieces of the grid; see PictureGroup.
std::string WhyRefused(vtkVolumeMapper* mapper, vtkVolumeProperty* property, const DrawnGrid& grid,
                       RenderMode mode, bool together);

} // namespace inr
