// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/TranslucentPeeler.h"

#include "Readers/Common/VTKCompat.h"
#include "Representations/Mapper/Window/OpaqueDepth.h"
#include "Representations/Mapper/Window/Props.h"

#include INR_VTK_OPENGL_HEADER
#include <vtkActor2D.h>
#include <vtkInformation.h>
#include <vtkInformationIntegerKey.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLActor.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderPass.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkRenderState.h>
#include <vtkRenderer.h>
#include <vtkShaderProgram.h>
#include <vtkTextureObject.h>
#include <vtkVolume.h>
#include <vtkWeakPointer.h>

#include <algorithm>

namespace {

/// Keeps of each pixel what lies between two depths, and the nearest of that. To be drawn with
/// depth test and without blending.
class vtkINRLayerPass : public vtkOpenGLRenderPass
{
public:
  static vtkINRLayerPass* New();
  vtkTypeMacro(vtkINRLayerPass, vtkOpenGLRenderPass);

  /// Window-space depths: red is the layer before, green what hides. Read at integer pixels.
  vtkNew<vtkTextureObject> Limits;

  void Render(const vtkRenderState* state) override
  {
    this->PreRender(state);
    vtkRenderer* renderer = state->GetRenderer();
    for (int k = 0; k < state->GetPropArrayCount(); ++k) {
      vtkProp* prop = state->GetPropArray()[k];
      vtkInformation* keys = prop->GetPropertyKeys();
      const bool had = keys->Has(vtkOpenGLActor::GLDepthMaskOverride()) != 0;
      const int mask = had ? keys->Get(vtkOpenGLActor::GLDepthMaskOverride()) : 0;
      keys->Set(vtkOpenGLActor::GLDepthMaskOverride(), 1);
      prop->RenderTranslucentPolygonalGeometry(renderer);
      keys->Remove(vtkOpenGLActor::GLDepthMaskOverride());
      if (had) {
        keys->Set(vtkOpenGLActor::GLDepthMaskOverride(), mask);
      }
    }
    this->PostRender(state);
  }

  bool PostReplaceShaderValues(std::string&, std::string&, std::string& fragment,
                               vtkAbstractMapper*, vtkProp*) override
  {
    // Some mappers have set the depth by themselves; then this finds nothing to replace.
    vtkShaderProgram::Substitute(fragment, "//VTK::Depth::Impl", "gl_FragDepth = gl_FragCoord.z;");
    vtkShaderProgram::Substitute(fragment, "//VTK::DepthPeeling::Dec",
                                 "uniform sampler2D inrLayerLimits;");
    // The tolerance is for drivers whose depths differ from one pass to the next.
    vtkShaderProgram::Substitute(
        fragment, "//VTK::DepthPeeling::PreColor",
        "vec2 inrLimits = texelFetch(inrLayerLimits, ivec2(gl_FragCoord.xy), 0).rg;\n"
        "  if (gl_FragDepth <= inrLimits.r + 2.5e-7 || gl_FragDepth >= inrLimits.g) { discard; }");
    return true;
  }

  bool SetShaderParameters(vtkShaderProgram* program, vtkAbstractMapper*, vtkProp*,
                           vtkOpenGLVertexArrayObject*) override
  {
    if (program->IsUniformUsed("inrLayerLimits")) {
      program->SetUniformi("inrLayerLimits", this->Limits->GetTextureUnit());
    }
    return true;
  }

protected:
  vtkINRLayerPass() = default;
  ~vtkINRLayerPass() override = default;
};

vtkStandardNewMacro(vtkINRLayerPass);

} // namespace

namespace inr {
namespace {

using Layer = TranslucentLayers::Layer;

/// Everything that drawing a layer changes, put back at the end of the scope.
struct LayerState
{
  LayerState(vtkOpenGLState* state, const Viewport& viewport)
      : State(state), DepthTest(state, GL_DEPTH_TEST), Blend(state, GL_BLEND),
        ScissorTest(state, GL_SCISSOR_TEST), DepthMask(state), DepthFunction(state),
        ColorMask(state), ClearColor(state), View(state), Scissor(state)
  {
    state->PushFramebufferBindings();
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthFunc(GL_LESS);
    state->vtkglDisable(GL_BLEND);
    state->vtkglDisable(GL_SCISSOR_TEST);
    state->vtkglViewport(0, 0, viewport.width, viewport.height);
    state->vtkglScissor(0, 0, viewport.width, viewport.height);
    state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    state->vtkglClearColor(0, 0, 0, 0);
    state->vtkglClearDepth(1.0);
  }
  ~LayerState() { this->State->PopFramebufferBindings(); }
  LayerState(const LayerState&) = delete;
  LayerState& operator=(const LayerState&) = delete;

  vtkOpenGLState* State;
  vtkOpenGLState::ScopedglEnableDisable DepthTest;
  vtkOpenGLState::ScopedglEnableDisable Blend;
  vtkOpenGLState::ScopedglEnableDisable ScissorTest;
  vtkOpenGLState::ScopedglDepthMask DepthMask;
  vtkOpenGLState::ScopedglDepthFunc DepthFunction;
  vtkOpenGLState::ScopedglColorMask ColorMask;
  vtkOpenGLState::ScopedglClearColor ClearColor;
  vtkOpenGLState::ScopedglViewport View;
  vtkOpenGLState::ScopedglScissor Scissor;
};

/// Premultiplied, as an 8-bit window would have it; nothing where a shader went wrong.
glm::vec4 Shown(const glm::vec4& straight)
{
  const auto part = [](float x) { return x > 0.0f ? std::min(x, 1.0f) : 0.0f; };
  const float opacity = part(straight.w);
  return {part(straight.x) * opacity, part(straight.y) * opacity, part(straight.z) * opacity,
          opacity};
}

/// Leaves out what does not lie behind `limits` (pairs of depths), as a mapper may not ask for
/// them, and moves them to the layer; false when nothing is left.
bool Finish(Layer& layer, std::vector<float>& limits)
{
  bool any = false;
  for (std::size_t k = 0; k < layer.depth.size(); ++k) {
    float& depth = layer.depth[k];
    const bool lies = depth < 1.0f && depth > limits[2 * k] && depth < limits[2 * k + 1];
    layer.colors[k] = lies ? Shown(layer.colors[k]) : glm::vec4(0.0f);
    depth = lies ? depth : 1.0f;
    limits[2 * k] = depth;
    any = any || lies;
  }
  return any;
}

std::vector<float> FirstLimits(const std::vector<float>& opaqueDepth, std::size_t pixels)
{
  std::vector<float> limits;
  limits.reserve(2 * pixels);
  for (std::size_t k = 0; k < pixels; ++k) {
    limits.push_back(-1.0f);
    limits.push_back(opaqueDepth.empty() ? 1.0f : opaqueDepth[k]);
  }
  return limits;
}

} // namespace

std::vector<vtkProp*> TranslucentProps(vtkRenderer* renderer)
{
  std::vector<vtkProp*> found;
  ForEachProp(renderer, [&](vtkProp* prop) {
    if (prop->GetVisibility() && !vtkVolume::SafeDownCast(prop) &&
        !vtkActor2D::SafeDownCast(prop) && prop->HasTranslucentPolygonalGeometry()) {
      found.push_back(prop);
    }
  });
  return found;
}

struct TranslucentPeeler::Resources
{
  bool prepare(vtkOpenGLRenderWindow* window, const Viewport& viewport);
  void draw(const vtkRenderState& state);
  Layer read(const Viewport& viewport) const;

  vtkWeakPointer<vtkOpenGLRenderWindow> Window;
  vtkNew<vtkINRLayerPass> Pass;
  vtkSmartPointer<vtkOpenGLFramebufferObject> Buffers;
  vtkNew<vtkTextureObject> Color;
  vtkNew<vtkTextureObject> Depth;
};

bool TranslucentPeeler::Resources::prepare(vtkOpenGLRenderWindow* window, const Viewport& viewport)
{
  const auto width = static_cast<unsigned int>(viewport.width);
  const auto height = static_cast<unsigned int>(viewport.height);
  this->Window = window;
  for (vtkTextureObject* texture :
       {this->Color.Get(), this->Depth.Get(), this->Pass->Limits.Get()}) {
    texture->SetContext(window);
    texture->SetMinificationFilter(vtkTextureObject::Nearest);
    texture->SetMagnificationFilter(vtkTextureObject::Nearest);
  }
  if (this->Color->GetWidth() != width || this->Color->GetHeight() != height) {
    this->Buffers = nullptr;
    if (!this->Color->Allocate2D(width, height, 4, VTK_FLOAT) ||
        !this->Depth->AllocateDepth(width, height, vtkTextureObject::Float32)) {
      return false;
    }
  }
  if (!this->Buffers) {
    this->Buffers = vtkSmartPointer<vtkOpenGLFramebufferObject>::New();
    this->Buffers->SetContext(window);
    this->Buffers->Bind();
    this->Buffers->AddColorAttachment(0, this->Color);
    this->Buffers->AddDepthAttachment(this->Depth);
  }
  this->Buffers->Bind();
  this->Buffers->ActivateBuffer(0);
  return this->Buffers->CheckFrameBufferStatus(GL_FRAMEBUFFER) != 0;
}

void TranslucentPeeler::Resources::draw(const vtkRenderState& state)
{
  this->Window->GetState()->vtkglDepthMask(GL_TRUE);
  this->Window->GetState()->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  this->Pass->Limits->Activate();
  this->Pass->Render(&state);
  this->Pass->Limits->Deactivate();
}

Layer TranslucentPeeler::Resources::read(const Viewport& viewport) const
{
  const auto pixels = static_cast<std::size_t>(viewport.width) * viewport.height;
  Layer layer{std::vector<float>(pixels), std::vector<glm::vec4>(pixels)};
  this->Buffers->Bind();
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, viewport.width, viewport.height, GL_DEPTH_COMPONENT, GL_FLOAT,
               layer.depth.data());
  glReadPixels(0, 0, viewport.width, viewport.height, GL_RGBA, GL_FLOAT, &layer.colors[0].x);
  return layer;
}

TranslucentPeeler::TranslucentPeeler() : Self(std::make_unique<Resources>()) {}
TranslucentPeeler::~TranslucentPeeler() = default;

std::shared_ptr<const TranslucentLayers>
TranslucentPeeler::peel(vtkRenderer* renderer, const Viewport& viewport,
                        const std::vector<vtkProp*>& props, const std::vector<float>& opaqueDepth)
{
  auto* window = vtkOpenGLRenderWindow::SafeDownCast(renderer->GetRenderWindow());
  if (!window || props.empty()) {
    return nullptr;
  }
  Resources& self = *this->Self;
  if (self.Window && self.Window != window) {
    this->release(self.Window);
  }
  window->MakeCurrent();
  const LayerState scope(window->GetState(), viewport);
  if (!self.prepare(window, viewport)) {
    return nullptr;
  }
  std::vector<vtkProp*> drawn = props;
  vtkRenderState state(renderer);
  state.SetPropArrayAndCount(drawn.data(), static_cast<int>(drawn.size()));
  const auto result = std::make_shared<TranslucentLayers>();
  const auto pixels = static_cast<std::size_t>(viewport.width) * viewport.height;
  std::vector<float> limits = FirstLimits(opaqueDepth, pixels);
  while (result->count() < MostLayers(static_cast<std::int64_t>(pixels))) {
    self.Pass->Limits->Create2DFromRaw(static_cast<unsigned int>(viewport.width),
                                       static_cast<unsigned int>(viewport.height), 2, VTK_FLOAT,
                                       limits.data());
    self.draw(state);
    Layer layer = self.read(viewport);
    if (!Finish(layer, limits)) {
      break;
    }
    result->layers.push_back(std::move(layer));
  }
  return result->count() > 0 ? result : nullptr;
}

void TranslucentPeeler::release(vtkWindow* window)
{
  Resources& self = *this->Self;
  if (self.Buffers && window) {
    self.Buffers->ReleaseGraphicsResources(window);
  }
  self.Buffers = nullptr;
  for (vtkTextureObject* texture : {self.Color.Get(), self.Depth.Get(), self.Pass->Limits.Get()}) {
    texture->ReleaseGraphicsResources(window);
  }
  self.Window = nullptr;
}

std::shared_ptr<const TranslucentLayers>
ReduceLayers(const TranslucentLayers& layers, const Viewport& viewport, int width, int height)
{
  const auto result = std::make_shared<TranslucentLayers>();
  for (const Layer& layer : layers.layers) {
    Layer reduced;
    reduced.depth = ReduceDepth(layer.depth, viewport, width, height);
    reduced.colors.reserve(reduced.depth.size());
    for (std::size_t pixel = 0; pixel < reduced.depth.size(); ++pixel) {
      reduced.colors.push_back(layer.colors[PixelUnder(pixel, width, height, viewport)]);
    }
    result->layers.push_back(std::move(reduced));
  }
  return result;
}

} // namespace inr
