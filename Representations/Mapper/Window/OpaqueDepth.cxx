// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/OpaqueDepth.h"

#include "Readers/Common/VTKCompat.h"
#include "Representations/Mapper/Window/Props.h"
#include "Representations/Mapper/Window/RenderTarget.h"

#include INR_VTK_OPENGL_HEADER
#include <vtkActor2D.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>

namespace inr {
namespace {

bool DrawsOpaque(vtkProp* prop)
{
  return prop->GetVisibility() && !vtkVolume::SafeDownCast(prop) &&
         !vtkActor2D::SafeDownCast(prop) && prop->HasOpaqueGeometry();
}

template <class Test> bool AnyProp(vtkRenderer* renderer, const Test& test)
{
  bool any = false;
  ForEachProp(renderer, [&](vtkProp* prop) { any = any || test(prop); });
  return any;
}

/// Of the framebuffer that is drawn into; empty where it has none, or several samples of a pixel.
std::vector<float> ReadBoundDepth(vtkRenderer* renderer, const Viewport& place)
{
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  vtkOpenGLState* state = window->GetState();
  int bound = 0;
  state->vtkglGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
  state->PushReadFramebufferBinding();
  state->vtkglBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<unsigned int>(bound));
  std::vector<float> depth(static_cast<std::size_t>(place.width) * place.height);
  state->vtkglPixelStorei(GL_PACK_ALIGNMENT, 1);
  for (int k = 0; k < 16 && glGetError() != GL_NO_ERROR; ++k) { // of others; without end if lost
  }
  glReadPixels(place.x, place.y, place.width, place.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               depth.data());
  const bool isRead = glGetError() == GL_NO_ERROR;
  state->PopReadFramebufferBinding();
  return isRead ? depth : std::vector<float>();
}

} // namespace

bool MayHaveOpaqueDepth(vtkRenderer* renderer)
{
  const bool erases = renderer->GetErase() && renderer->GetRenderWindow()->GetErase();
  return renderer->GetPreserveDepthBuffer() || !erases || AnyProp(renderer, DrawsOpaque);
}

bool MayHideByWhatIsNotPicked(vtkRenderer* renderer)
{
  return AnyProp(renderer, [](vtkProp* prop) { return !prop->GetPickable() && DrawsOpaque(prop); });
}

std::vector<float> ReadOpaqueDepth(vtkRenderer* renderer, const Viewport& viewport)
{
  const RenderTarget target = TargetOf(renderer, viewport);
  if (!target.isWindow) {
    const std::vector<float> depth = ReadBoundDepth(renderer, target.viewport);
    return depth.empty() ? depth
                         : ReduceDepth(depth, target.viewport, viewport.width, viewport.height);
  }
  std::vector<float> depth(static_cast<std::size_t>(viewport.width) * viewport.height);
  const int ok = renderer->GetRenderWindow()->GetZbufferData(
      viewport.x, viewport.y, viewport.x + viewport.width - 1, viewport.y + viewport.height - 1,
      depth.data());
  return ok ? depth : std::vector<float>();
}

std::vector<float> ReduceDepth(const std::vector<float>& depth, const Viewport& viewport, int width,
                               int height)
{
  std::vector<float> result(static_cast<std::size_t>(width) * height);
  for (std::size_t pixel = 0; pixel < result.size(); ++pixel) {
    result[pixel] = depth[PixelUnder(pixel, width, height, viewport)];
  }
  return result;
}

} // namespace inr
