// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkSMViewProxy.h"
#include "vtkWeakPointer.h"

namespace inr {

/// A still picture that a view of this client has drawn, as all screenshots are.
struct StillRender
{
  vtkWeakPointer<vtkSMViewProxy> view; ///< null when there was none, or it is deleted
  int size[2] = {0, 0};                ///< pixels of the window
  int stereoType = 0;                  ///< VTK_STEREO_..., 0: none
  bool sameStereo = false;             ///< stereo was on all the time since the one before
  vtkMTimeType time = 0;               ///< when it was complete
};

/// From now on what `view` draws counts below.
void WatchStillRenders(vtkSMViewProxy* view);

/// The latest one of all views, and the one before.
const StillRender& LatestStillRender();
const StillRender& StillRenderBefore();

} // namespace inr
