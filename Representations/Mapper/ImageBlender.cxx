// SPDX-License-Identifier: BSD-3-Clause
#include "ImageBlender.h"

#include "Readers/VTKCompat.h"

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
uniform vec3 identity;
void main()
{
  if (texture2D(image, texCoord).a <= 0.0)
  {
    discard;
  }
  gl_FragData[0] = vec4(identity, 1.0);
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

bool ImageBlender::upload(vtkOpenGLRenderWindow* window, const Viewport& viewport,
                          const Image& rgba)
{
  Resources& self = *this->Self;
  if (self.Window && self.Window != window) {
    this->release(self.Window);
  }
  window->MakeCurrent();
  self.Window = window;
  self.Texture->SetContext(window);
  const bool exact = rgba.width == viewport.width && rgba.height == viewport.height;
  self.Texture->SetLinearMagnification(!exact);
  self.Texture->SetMinificationFilter(exact ? vtkTextureObject::Nearest : vtkTextureObject::Linear);
  self.Texture->SetWrapS(vtkTextureObject::ClampToEdge);
  self.Texture->SetWrapT(vtkTextureObject::ClampToEdge);
  // VTK's signature wants a mutable pointer and does not write through it.
  return self.Texture->Create2DFromRaw(static_cast<unsigned int>(rgba.width),
                                       static_cast<unsigned int>(rgba.height), 4, VTK_FLOAT,
                                       const_cast<float*>(rgba.pixels.data()));
}

/// With `color`, identities.
bool ImageBlender::draw(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba,
                        const float* color)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window || !this->upload(window, viewport, rgba)) {
    return false;
  }
  std::unique_ptr<vtkOpenGLQuadHelper>& quad = color ? this->Self->Identities : this->Self->Colors;
  if (quad) {
    window->GetShaderCache()->ReadyShaderProgram(quad->Program);
  } else {
    quad = std::make_unique<vtkOpenGLQuadHelper>(window, nullptr,
                                                 color ? IdentityShader : ColorShader, nullptr);
  }
  if (!quad->Program) {
    return false;
  }
  const DrawingState scope(window->GetState(), viewport, !color);
  vtkTextureObject* texture = this->Self->Texture;
  texture->Activate();
  quad->Program->SetUniformi("image", texture->GetTextureUnit());
  if (color) {
    quad->Program->SetUniform3f("identity", color);
  }
  quad->Render();
  texture->Deactivate();
  return true;
}

bool ImageBlender::blend(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba)
{
  return this->draw(renderer, viewport, rgba, nullptr);
}

bool ImageBlender::mark(vtkRenderer* renderer, const Viewport& viewport, const Image& rgba,
                        const float color[3])
{
  return this->draw(renderer, viewport, rgba, color);
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
