// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/ImageBlender.h"

#include "Readers/Common/VTKCompat.h"
#include "Representations/Mapper/Window/RenderTarget.h"

#include INR_VTK_OPENGL_HEADER
#include <vtkNew.h>
#include <vtkOpenGLQuadHelper.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLShaderCache.h>
#include <vtkOpenGLState.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtkWeakPointer.h>

namespace inr {
namespace {

constexpr const char* ColorShader = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec2 texCoord;
uniform sampler2D image;
void main()
{
  gl_FragData[0] = texture2D(image, texCoord);
}
)";

constexpr const char* IdentityShader = R"(//VTK::System::Dec
//VTK::Output::Dec
in vec2 texCoord;
uniform sampler2D image;
void main()
{
  vec4 identity = texture2D(image, texCoord);
  if (identity.a <= 0.0)
  {
    discard;
  }
  gl_FragData[0] = identity;
}
)";

/// Everything that drawing the quad changes, put back at the end of the scope.
struct DrawingState
{
  DrawingState(vtkOpenGLState* state, const Viewport& viewport, bool blends)
      : DepthTest(state, GL_DEPTH_TEST), Blend(state, GL_BLEND),
        ScissorTest(state, GL_SCISSOR_TEST), DepthMask(state), BlendFunction(state), View(state),
        Scissor(state)
  {
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglDepthMask(GL_FALSE);
    state->SetEnumState(GL_BLEND, blends);
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    state->vtkglEnable(GL_SCISSOR_TEST);
    state->vtkglViewport(viewport.x, viewport.y, viewport.width, viewport.height);
    state->vtkglScissor(viewport.x, viewport.y, viewport.width, viewport.height);
  }

  vtkOpenGLState::ScopedglEnableDisable DepthTest;
  vtkOpenGLState::ScopedglEnableDisable Blend;
  vtkOpenGLState::ScopedglEnableDisable ScissorTest;
  vtkOpenGLState::ScopedglDepthMask DepthMask;
  vtkOpenGLState::ScopedglBlendFuncSeparate BlendFunction;
  vtkOpenGLState::ScopedglViewport View;
  vtkOpenGLState::ScopedglScissor Scissor;
};

} // namespace

struct ImageBlender::Resources
{
  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkNew<vtkTextureObject> Texture;
  std::unique_ptr<vtkOpenGLQuadHelper> Colors;
  std::unique_ptr<vtkOpenGLQuadHelper> Identities;
};

ImageBlender::ImageBlender() : Self(std::make_unique<Resources>()) {}
ImageBlender::~ImageBlender() = default;

bool ImageBlender::upload(vtkOpenGLRenderWindow* window, const Image& rgba, bool smooth)
{
  Resources& self = *this->Self;
  if (self.Window && self.Window != window) {
    this->release(self.Window);
  }
  window->MakeCurrent();
  self.Window = window;
  self.Texture->SetContext(window);
  self.Texture->SetLinearMagnification(smooth);
  self.Texture->SetMinificationFilter(smooth ? vtkTextureObject::Linear
                                             : vtkTextureObject::Nearest);
  self.Texture->SetWrapS(vtkTextureObject::ClampToEdge);
  self.Texture->SetWrapT(vtkTextureObject::ClampToEdge);
  // VTK's signature wants a mutable pointer and does not write through it.
  return self.Texture->Create2DFromRaw(static_cast<unsigned int>(rgba.width),
                                       static_cast<unsigned int>(rgba.height), 4, VTK_FLOAT,
                                       const_cast<float*>(rgba.pixels.data()));
}

bool ImageBlender::draw(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba,
                        Mode mode)
{
  const bool blends = mode == Mode::Blend;
  const Viewport target = TargetOf(renderer, viewport).viewport;
  const bool exact = rgba.width == target.width && rgba.height == target.height;
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window || !this->upload(window, rgba, blends && !exact)) {
    return false;
  }
  std::unique_ptr<vtkOpenGLQuadHelper>& quad = blends ? this->Self->Colors : this->Self->Identities;
  if (quad) {
    window->GetShaderCache()->ReadyShaderProgram(quad->Program);
  } else {
    quad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr,
                                                 blends ? ColorShader : IdentityShader, nullptr);
  }
  if (!quad->Program) {
    return false;
  }
  const DrawingState scope(window->GetState(), target, blends);
  vtkTextureObject* texture = this->Self->Texture;
  texture->Activate();
  quad->Program->SetUniformi("image", texture->GetTextureUnit());
  quad->Render();
  texture->Deactivate();
  return true;
}

bool ImageBlender::blend(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba)
{
  return this->draw(renderer, viewport, rgba, Mode::Blend);
}

bool ImageBlender::mark(vtkRenderer* renderer, const Viewport& viewport, const Image& identities)
{
  return this->draw(renderer, viewport, identities, Mode::Mark);
}

void ImageBlender::release(vtkWindow* window)
{
  for (std::unique_ptr<vtkOpenGLQuadHelper>* quad :
       {&this->Self->Colors, &this->Self->Identities}) {
    if (*quad && window) {
      (*quad)->ReleaseGraphicsResources(window);
    }
    quad->reset();
  }
  this->Self->Texture->ReleaseGraphicsResources(window);
  this->Self->Window = nullptr;
}

} // namespace inr
