// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/RenderTarget.h"

#include "Readers/Common/VTKCompat.h"

#include INR_VTK_OPENGL_HEADER
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>

namespace inr {

RenderTarget TargetOf(vtkRenderer* renderer, const Viewport& viewport)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  vtkOpenGLFramebufferObject* own = window ? window->GetRenderFramebuffer() : nullptr;
  if (!own) {
    return {true, viewport};
  }
  int bound = 0;
  window->GetState()->vtkglGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  if (static_cast<unsigned int>(bound) == own->GetFBOIndex()) {
    return {true, viewport};
  }
  int place[4];
  window->GetState()->vtkglGetIntegerv(GL_VIEWPORT, place); // as the pass has set it
  return {false, {place[0], place[1], place[2], place[3]}};
}

} // namespace inr
