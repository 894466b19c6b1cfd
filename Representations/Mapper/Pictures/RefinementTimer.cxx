// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/RefinementTimer.h"

#include "Representations/Mapper/Pictures/ImageReduction.h"

#include <vtkCommand.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <utility>

namespace inr {

namespace {
constexpr double Patience = 0.2; ///< seconds until a busy application is asked again
/// Before the application's observers: a timer that fires must not be destroyed by what these do.
constexpr float First = 1000;
constexpr vtkCommand::EventIds Observed[] = {
    vtkCommand::TimerEvent,
    vtkCommand::StartInteractionEvent,
    vtkCommand::EndInteractionEvent,
    vtkCommand::LeftButtonPressEvent,
    vtkCommand::LeftButtonReleaseEvent,
    vtkCommand::MiddleButtonPressEvent,
    vtkCommand::MiddleButtonReleaseEvent,
    vtkCommand::RightButtonPressEvent,
    vtkCommand::RightButtonReleaseEvent,
};

/// The buttons that are down after an event of one of them.
unsigned ButtonsAfter(unsigned long event, unsigned before)
{
  switch (event) {
  case vtkCommand::LeftButtonPressEvent:
    return before | 1u;
  case vtkCommand::LeftButtonReleaseEvent:
    return before & ~1u;
  case vtkCommand::MiddleButtonPressEvent:
    return before | 2u;
  case vtkCommand::MiddleButtonReleaseEvent:
    return before & ~2u;
  case vtkCommand::RightButtonPressEvent:
    return before | 4u;
  default:
    return before & ~4u;
  }
}

} // namespace

bool IsInteractive(vtkRenderWindow* window)
{
  return window && window->GetDesiredUpdateRate() >= ImageReduction::StillRate;
}

RefinementTimer::RefinementTimer(std::function<bool()> mayRefine, std::function<void()> begin)
    : MayRefine(std::move(mayRefine)), Begin(std::move(begin))
{
  this->Command->SetClientData(this);
  this->Command->SetCallback(&RefinementTimer::OnEvent);
}

bool RefinementTimer::isWatched(vtkRenderWindow* window)
{
  if (!window) {
    return false;
  }
  // A window that has drawn nothing yet makes its interactor ready when it does.
  vtkRenderWindowInteractor* interactor = window->GetInteractor();
  return interactor && (interactor->GetInitialized() || window->GetNeverRendered()) &&
         !window->GetOffScreenRendering();
}

bool RefinementTimer::canRefine(vtkRenderWindow* window)
{
  const bool isTile = window && (window->GetTileScale()[0] > 1 || window->GetTileScale()[1] > 1);
  return isWatched(window) && window->GetSwapBuffers() && !isTile;
}

void RefinementTimer::request(vtkRenderWindow* window, double pause)
{
  this->start(window->GetInteractor(), pause);
}

void RefinementTimer::postpone()
{
  if (this->Pending && this->Interactor) {
    this->start(this->Interactor, Patience);
  }
}

void RefinementTimer::cancel()
{
  this->stop();
  this->Pending = false;
}

void RefinementTimer::forget()
{
  this->cancel();
  if (this->Interactor) {
    this->Interactor->RemoveObserver(this->Command);
  }
  this->Interactor = nullptr;
}

// From now on, whether there is a picture to wait for or not: when there is one, somebody may be in
// the midst of an interaction.
void RefinementTimer::observe(vtkRenderWindowInteractor* interactor)
{
  this->forget();
  this->Interactor = interactor;
  this->Interacting = false;
  this->Buttons = 0;
  for (const auto event : Observed) {
    interactor->AddObserver(event, this->Command, First);
  }
}

void RefinementTimer::start(vtkRenderWindowInteractor* interactor, double pause)
{
  this->stop();
  if (this->Interactor != interactor) {
    this->observe(interactor);
  }
  this->Timer = interactor->CreateOneShotTimer(static_cast<unsigned long>(pause * 1000));
  this->Pending = this->Timer != 0; // else there is no event loop to tell the time
}

void RefinementTimer::stop()
{
  if (this->Interactor && this->Timer != 0) {
    this->Interactor->DestroyTimer(this->Timer);
  }
  this->Timer = 0;
}

bool RefinementTimer::isBusy() const
{
  // VTK's styles have the rate of interactive pictures as long as a button is down; ParaView says
  // so by events.
  vtkRenderWindow* window = this->Interactor->GetRenderWindow();
  return this->Interacting || !window || IsInteractive(window);
}

// ParaView 5.11's selections by mouse begin as an interaction and end without a word: to the view,
// all pictures that its interactor asks for are interactive ones from then on.
bool RefinementTimer::endForgottenInteraction(vtkRenderWindowInteractor* interactor)
{
  const bool forgotten = this->Interacting && this->Released;
  if (forgotten) {
    interactor->InvokeEvent(vtkCommand::EndInteractionEvent);
  }
  return forgotten;
}

void RefinementTimer::OnEvent(vtkObject*, unsigned long event, void* self, void* data)
{
  auto* refinement = static_cast<RefinementTimer*>(self);
  switch (event) {
  case vtkCommand::TimerEvent:
    if (data && refinement->Timer != 0 && *static_cast<int*>(data) == refinement->Timer) {
      refinement->fire();
    }
    break;
  case vtkCommand::StartInteractionEvent:
    refinement->Interacting = true;
    refinement->Released = false;
    break;
  case vtkCommand::EndInteractionEvent:
    refinement->Interacting = false;
    break;
  default:
    refinement->Buttons = ButtonsAfter(event, refinement->Buttons);
    refinement->Released = refinement->Buttons == 0;
  }
}

void RefinementTimer::fire()
{
  // VTK's interactor for X is going through its timers: the one that fires must stay until then.
  const vtkSmartPointer<vtkRenderWindowInteractor> interactor = this->Interactor.GetPointer();
  interactor->DestroyTimer(this->Fired);
  this->Fired = std::exchange(this->Timer, 0);
  const std::weak_ptr<const bool> life = this->Life;
  const bool forgotten = this->endForgottenInteraction(interactor);
  if (life.expired() || !this->Pending || this->Timer != 0) { // the application has seen to it
    return;
  }
  const bool busy = (this->isBusy() && !forgotten) || !this->MayRefine();
  if (life.expired()) {
    return;
  }
  if (busy) {
    this->start(interactor, Patience);
    return;
  }
  this->Begin();
  interactor->Render(); // which may delete the mapper, and this
  if (!life.expired() && !this->Interacting && IsInteractive(interactor->GetRenderWindow())) {
    // The view believes in an interaction that was forgotten before this observed any.
    interactor->InvokeEvent(vtkCommand::EndInteractionEvent);
    interactor->Render();
  }
}

} // namespace inr
