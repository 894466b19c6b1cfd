// SPDX-License-Identifier: BSD-3-Clause
#include "RefinementTimer.h"

#include <vtkCommand.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

namespace inr {

namespace {
constexpr unsigned long DelayInMilliseconds = 10;
}

RefinementTimer::RefinementTimer()
{
  this->Command->SetClientData(this);
  this->Command->SetCallback(&RefinementTimer::OnTimer);
}

bool RefinementTimer::canRefine(vtkRenderWindow* window)
{
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  return interactor && interactor->GetInitialized() && !window->GetOffScreenRendering() &&
         window->GetSwapBuffers();
}

void RefinementTimer::request(vtkRenderWindow* window)
{
  if (this->Timer != 0) {
    return;
  }
  this->Interactor = window->GetInteractor();
  this->Observer = this->Interactor->AddObserver(vtkCommand::TimerEvent, this->Command);
  this->Timer = this->Interactor->CreateOneShotTimer(DelayInMilliseconds);
  if (this->Timer == 0) { // no event loop to tell the time
    this->cancel();
  }
}

void RefinementTimer::cancel()
{
  if (this->Interactor) {
    if (this->Timer != 0) {
      this->Interactor->DestroyTimer(this->Timer);
    }
    this->Interactor->RemoveObserver(this->Observer);
  }
  this->Interactor = nullptr;
  this->Timer = 0;
}

void RefinementTimer::OnTimer(vtkObject* caller, unsigned long, void* self, void* timer)
{
  auto* refinement = static_cast<RefinementTimer*>(self);
  if (!timer || *static_cast<int*>(timer) != refinement->Timer) {
    return;
  }
  // VTK's interactor for X is going through its timers: the one that fires must stay until then.
  auto* interactor = static_cast<vtkRenderWindowInteractor*>(caller);
  interactor->DestroyTimer(refinement->Fired);
  refinement->Fired = refinement->Timer;
  refinement->Timer = 0;
  refinement->cancel();
  // Nothing of `refinement` from here on: rendering may delete the mapper.
  interactor->Render();
}

} // namespace inr
