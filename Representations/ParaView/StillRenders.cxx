// SPDX-License-Identifier: BSD-3-Clause
#include "StillRenders.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"
#include "vtkTimeStamp.h"

#include <algorithm>
#include <utility>

namespace inr {

namespace {

struct LatestTwo
{
  StillRender latest;
  StillRender before;
  bool stereoWasOff = true; ///< in a window that was drawn into, since the latest
};

LatestTwo& Renders()
{
  static LatestTwo renders;
  return renders;
}

void OnWindowModified(vtkObject* caller, unsigned long, void*, void*)
{
  auto* window = static_cast<vtkRenderWindow*>(caller);
  Renders().stereoWasOff = Renders().stereoWasOff || !window->GetStereoRender();
}

/// Has `object` call back, once however often this is asked for.
void Observe(vtkObject* object, unsigned long event, vtkCallbackCommand* command)
{
  if (!object->HasObserver(event, command)) {
    object->AddObserver(event, command);
  }
}

vtkSmartPointer<vtkCallbackCommand> CommandOf(void (*callback)(vtkObject*, unsigned long, void*,
                                                               void*))
{
  auto command = vtkSmartPointer<vtkCallbackCommand>::New();
  command->SetCallback(callback);
  return command;
}

void OnEnd(vtkObject* caller, unsigned long, void*, void* isInteractive)
{
  auto* view = vtkSMViewProxy::SafeDownCast(caller);
  if (!view || !isInteractive || *static_cast<const int*>(isInteractive) != 0) {
    return;
  }
  LatestTwo& renders = Renders();
  StillRender now;
  now.view = view;
  vtkTimeStamp end;
  end.Modified();
  now.time = end.GetMTime();
  if (vtkRenderWindow* window = view->GetRenderWindow()) {
    std::copy_n(window->GetActualSize(), 2, now.size);
    now.stereoType = window->GetStereoRender() ? window->GetStereoType() : 0;
    static const vtkSmartPointer<vtkCallbackCommand> command = CommandOf(OnWindowModified);
    Observe(window, vtkCommand::ModifiedEvent, command);
  }
  now.sameStereo = !std::exchange(renders.stereoWasOff, false);
  renders.before = renders.latest;
  renders.latest = now;
}

} // namespace

void WatchStillRenders(vtkSMViewProxy* view)
{
  static const vtkSmartPointer<vtkCallbackCommand> command = CommandOf(OnEnd);
  Observe(view, vtkCommand::EndEvent, command); // it may be registered once more
}

const StillRender& LatestStillRender() { return Renders().latest; }
const StillRender& StillRenderBefore() { return Renders().before; }

} // namespace inr
