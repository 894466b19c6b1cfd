// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Window/DeferredDrawing.h"

#include "Representations/Mapper/Window/Props.h"

#include <vtkActor2D.h>
#include <vtkCommand.h>
#include <vtkInformation.h>
#include <vtkInformationObjectBaseVectorKey.h>
#include <vtkOpenGLRenderPass.h>

#include <algorithm>

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
  bool isWatched = false;
  for (const Waiting& waiting : this->Requested) {
    if (waiting.renderer == renderer && waiting.volume == volume) {
      return; // the next peel of the same frame
    }
    isWatched = isWatched || waiting.renderer == renderer;
  }
  if (!isWatched) {
    renderer->AddObserver(vtkCommand::EndEvent, this->Command);
  }
  this->Requested.push_back({renderer, volume});
}

void DeferredDrawing::cancel()
{
  for (const Waiting& waiting : this->Requested) {
    if (waiting.renderer) {
      waiting.renderer->RemoveObserver(this->Command);
    }
  }
  this->Requested.clear();
}

void DeferredDrawing::draw(vtkRenderer* renderer)
{
  renderer->RemoveObserver(this->Command);
  const auto others = std::stable_partition(
      this->Requested.begin(), this->Requested.end(),
      [renderer](const Waiting& waiting) { return waiting.renderer == renderer; });
  const std::vector<Waiting> due(this->Requested.begin(), others);
  this->Requested.erase(this->Requested.begin(), others);
  for (const Waiting& waiting : due) {
    if (waiting.volume) {
      this->DrawVolume(renderer, waiting.volume);
    }
  }
  RedrawOverlays(renderer);
}

void DeferredDrawing::OnEnd(vtkObject* renderer, unsigned long, void* self, void*)
{
  static_cast<DeferredDrawing*>(self)->draw(static_cast<vtkRenderer*>(renderer));
}

} // namespace inr
