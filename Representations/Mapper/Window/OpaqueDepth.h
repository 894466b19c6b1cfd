// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Representations/Mapper/Scene/Viewport.h"

#include <vector>

class vtkRenderer;

namespace inr {

/// Whether the depth buffer can hold anything: a visible prop with opaque geometry (volumes and
/// overlays have none), or the depth of an earlier renderer or picture that this one keeps.
bool MayHaveOpaqueDepth(vtkRenderer* renderer);

/// Whether something in front of a volume, or in its midst, can be one that nobody selects, such as
/// the highlight of an earlier selection.
bool MayHideByWhatIsNotPicked(vtkRenderer* renderer);

/// Window-space depth of the viewport, row 0 at the bottom, multisampling resolved; empty when VTK
/// cannot read it. The render window must be current.
std::vector<float> ReadOpaqueDepth(vtkRenderer* renderer, const Viewport& viewport);

/// The depth at the centres of the pixels of a smaller image over the same viewport.
std::vector<float> ReduceDepth(const std::vector<float>& depth, const Viewport& viewport, int width,
                               int height);

} // namespace inr
