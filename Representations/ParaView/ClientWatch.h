// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkWeakPointer.h"

#include <chrono>
#include <optional>
#include <vector>

class vtkObject;
class vtkSMProxy;

namespace inr {

/// Knows when ParaView's client has something else to do than to refine a picture.
class ClientWatch
{
public:
  ClientWatch();
  ~ClientWatch();
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;

  /// Finds the client's animations and its views but for `own`, whose picture it is; there may be
  /// more than before. Cheap. There are none in a server.
  void update(const vtkObject& own);
  /// Whether an animation plays, a modal dialog is open or somebody turns another view.
  bool isBusy();

private:
  using Clock = std::chrono::steady_clock;

  bool isWatched(const vtkObject* object) const;
  void watchScene(vtkObject* scene);
  void watchView(vtkSMProxy* view, const vtkObject& own);
  bool isTurning();
  static void OnPlay(vtkObject* scene, unsigned long event, void* self, void* unused);
  static void OnPicture(vtkObject* view, unsigned long event, void* self, void* isInteractive);

  std::vector<vtkWeakPointer<vtkObject>> Watched;
  vtkWeakPointer<vtkObject> Playing;
  /// When another view was last drawn for somebody who turns it, until that has ended, and whether
  /// he held a mouse button down.
  std::optional<Clock::time_point> Turned;
  bool IsHeld = false;
  vtkNew<vtkCallbackCommand> Play;
  vtkNew<vtkCallbackCommand> Picture;
};

} // namespace inr
