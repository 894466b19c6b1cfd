// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"

#include <optional>
#include <vector>

class vtkRenderer;
class vtkVolumeProperty;

namespace inr {

/// The renderer's lights that are switched on and give light, in world space, headlights and camera
/// lights where the camera has taken them. Colour is VTK's diffuse colour times intensity; spots of
/// 90 degrees and more are points, as everywhere in VTK.
std::vector<Light> SceneLights(vtkRenderer* renderer);

/// How a volume answers light; none unless shading is on.
std::optional<Material> MaterialOf(vtkVolumeProperty* property);

} // namespace inr
