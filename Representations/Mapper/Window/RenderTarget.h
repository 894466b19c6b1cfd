// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Representations/Mapper/Scene/Viewport.h"

class vtkRenderer;

namespace inr {

/// What a renderer draws into: its window or, within a render pass such as vtkSSAAPass, a
/// framebuffer of that pass, which may have more pixels.
struct RenderTarget
{
  bool isWindow = true;
  Viewport viewport; ///< of the renderer, in the target's pixels
};

/// `viewport` is the renderer's, in its window. The render window must be current.
RenderTarget TargetOf(vtkRenderer* renderer, const Viewport& viewport);

} // namespace inr
