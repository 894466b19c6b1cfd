// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkWeakPointer.h>

class vtkObject;
class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace inr {

/// Has a window rendered again a moment later, through its interactor: that way it is the
/// application that renders, with everything it does around a picture, and only when its event loop
/// is idle.
class RefinementTimer
{
public:
  RefinementTimer();
  ~RefinementTimer() { this->cancel(); }
  RefinementTimer(const RefinementTimer&) = delete;
  RefinementTimer& operator=(const RefinementTimer&) = delete;

  /// Whether `window` belongs to an application that can be asked. False while the picture is being
  /// captured: a screenshot has no later.
  static bool canRefine(vtkRenderWindow* window);
  /// One more picture; does nothing while one is already asked for.
  void request(vtkRenderWindow* window);
  void cancel();

private:
  static void OnTimer(vtkObject* caller, unsigned long event, void* self, void* timer);

  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  vtkNew<vtkCallbackCommand> Command;
  unsigned long Observer = 0;
  int Timer = 0;
  int Fired = 0; ///< the timer before
};

} // namespace inr
