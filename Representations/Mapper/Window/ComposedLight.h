// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Image/Image.h"
#include "Representations/Mapper/Scene/Viewport.h"
#include "Representations/Mapper/Window/PictureGroup.h"
#include "Representations/Mapper/Window/Surroundings.h"

class vtkRenderer;

namespace inr {

/// Takes from the premultiplied picture of a group, which the process that draws it has, the light
/// that would be more than white together with what shows through of the surfaces in all windows.
/// One window limits that by itself; several are composed in 8 bits, which overflow to black.
/// `around` is of as many pixels as the picture and the same in all processes, which call this
/// together.
void LimitLight(Image& rgba, const Surroundings& around, const PictureGroup& group,
                vtkRenderer* renderer, const Viewport& viewport);

} // namespace inr
