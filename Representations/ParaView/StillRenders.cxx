// SPDX-License-Identifier: BSD-3-Clause
#include "StillRenders.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"

#include <algorithm>

namespace inr {

namespace {

struct LatestTwo
{
  StillRender latest;
  StillRender before;
};

LatestTwo& Renders()
{
  static LatestTwo renders;
  return renders;
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
  now.number = renders.latest.number + 1;
  if (vtkRenderWindow* window = view->GetRenderWindow()) {
    std::copy_n(window->GetActualSize(), 2, now.size);
    now.stereoType = window->GetStereoRender() ? window->GetStereoType() : 0;
  }
  renders.before = renders.latest;
  renders.latest = now;
}

} // namespace

void WatchStillRenders(vtkSMViewProxy* view)
{
  static const vtkNew<vtkCallbackCommand> command = [] {
    vtkNew<vtkCallbackCommand> made;
    made->SetCallback(OnEnd);
    return made;
  }();
  if (!view->HasObserver(vtkCommand::EndEvent, command)) { // it may be registered once more
    view->AddObserver(vtkCommand::EndEvent, command);
  }
}

const StillRender& LatestStillRender() { return Renders().latest; }
const StillRender& StillRenderBefore() { return Renders().before; }

} // namespace inr
