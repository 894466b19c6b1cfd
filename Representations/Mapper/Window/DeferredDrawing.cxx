// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/DeferredDrawing.h"

#include "Representations/Mapper/Window/Props.h"

#include <vtkActor2D.h>
#include <vtkCommand.h>
#include <vtkInformation.h>
#include <vtkInformationObjectBaseVectorKey.h>
#include <vtkOpenGLRenderPass.h>

namespace inr {

namespace {

void RedrawOverlays(vtkRenderer* renderer)
{
  ForEachProp(renderer, [&](vtkProp* prop) {
    if (prop->GetVisibility() && vtkActor2D::SafeDownCast(prop)) {
      prop->RenderOverlay(renderer);
    }
  });
}

} // namespace

DeferredDrawing::DeferredDrawing(Draw draw) : DrawVolume(std::move(draw))
{
  this->Command->SetClientData(this);
  this->Command->SetCallback(&DeferredDrawing::OnEnd);
}

bool DeferredDrawing::isDue(vtkVolume* volume)
{
  vtkInformation* keys = volume->GetPropertyKeys();
  return keys && keys->Has(vtkOpenGLRenderPass::RenderPasses());
}

void DeferredDrawing::request(vtkRenderer* renderer, vtkVolume* volume)
{
  if (this->Renderer == renderer && this->Volume == volume) {
    return; // the next peel of the same frame
  }
  this->cancel();
  this->Renderer = renderer;
  this->Volume = volume;
  renderer->AddObserver(vtkCommand::EndEvent, this->Command);
}

void DeferredDrawing::cancel()
{
  if (this->Renderer) {
    this->Renderer->RemoveObserver(this->Command);
  }
  this->Renderer = nullptr;
  this->Volume = nullptr;
}

void DeferredDrawing::drawNow()
{
  const vtkWeakPointer<vtkRenderer> renderer = this->Renderer;
  const vtkWeakPointer<vtkVolume> volume = this->Volume;
  this->cancel();
  if (renderer && volume) {
    this->DrawVolume(renderer, volume);
    RedrawOverlays(renderer);
  }
}

void DeferredDrawing::OnEnd(vtkObject*, unsigned long, void* self, void*)
{
  static_cast<DeferredDrawing*>(self)->drawNow();
}

} // namespace inr
