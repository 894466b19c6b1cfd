// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkWeakPointer.h>

#include <functional>
#include <memory>

class vtkObject;
class vtkRenderWindow;
class vtkRenderWindowInteractor;

namespace inr {

/// Whether the application wants a picture of a window, which may be null, soon, as while the
/// camera moves.
bool IsInteractive(vtkRenderWindow* window);

/// Has a window rendered again a moment later, through its interactor: that way it is the
/// application that renders, with everything it does around a picture, and only when its event loop
/// is idle. Waits while somebody interacts with the window or the application says that it is busy.
class RefinementTimer
{
public:
  /// `mayRefine` is asked before a picture and may destroy this; false: again a little later. After
  /// true, `begin` is called right before the picture.
  RefinementTimer(std::function<bool()> mayRefine, std::function<void()> begin);
  ~RefinementTimer() { this->forget(); }
  RefinementTimer(const RefinementTimer&) = delete;
  RefinementTimer& operator=(const RefinementTimer&) = delete;

  /// Whether `window` is on the screen and belongs to an application, which somebody may wait for.
  static bool isWatched(vtkRenderWindow* window);
  /// Whether that can be asked. False while the picture is being captured: a screenshot has no
  /// later.
  static bool canRefine(vtkRenderWindow* window);
  /// Whether the picture of such a window is captured instead.
  static bool isCaptured(vtkRenderWindow* window)
  {
    return isWatched(window) && !canRefine(window);
  }
  /// One more picture in `pause` seconds, instead of one that was asked for before.
  void request(vtkRenderWindow* window, double pause);
  /// If one is asked for, not before somebody has stopped to ask for interactive ones.
  void postpone();
  void cancel();

private:
  static void OnEvent(vtkObject* caller, unsigned long event, void* self, void* data);
  void fire();
  bool isBusy() const;
  /// Whether there was one. May destroy this, as it is the application that hears of it.
  bool endForgottenInteraction(vtkRenderWindowInteractor* interactor);
  void start(vtkRenderWindowInteractor* interactor, double pause);
  void stop();
  void observe(vtkRenderWindowInteractor* interactor);
  void forget();

  std::function<bool()> MayRefine;
  std::function<void()> Begin;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor;
  vtkNew<vtkCallbackCommand> Command;
  bool Pending = false;     ///< a picture is asked for, or being made because it was
  bool Interacting = false; ///< a mouse button is down, whether the mouse moves or not
  bool Released = false;    ///< the last button, since that began
  unsigned Buttons = 0;     ///< that are down, a bit for each
  int Timer = 0;
  int Fired = 0;                                                   ///< the timer before
  std::shared_ptr<const bool> Life = std::make_shared<bool>(true); ///< ends with this
};

} // namespace inr
