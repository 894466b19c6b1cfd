// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/Frame.h"
#include "Representations/Mapper/Pictures/PaintSettings.h"
#include "Representations/Mapper/Pictures/PictureStore.h"
#include "Representations/Mapper/Pictures/RefinementTimer.h"

#include <functional>
#include <utility>

class vtkRenderWindow;
class vtkRenderer;

namespace inr {

/// Seconds for a picture, or for what a click selects of one; 0: as many as it takes.
double TimeLimit(vtkRenderer* renderer, const PaintSettings& settings);

/// Sees to it that still pictures go on which are not complete: in a window by its timer; of those
/// that somebody else shows by telling him when.
class StillPictures
{
public:
  /// `pictures` must outlive it; for `mayRefine` see RefinementTimer.
  StillPictures(PictureStore& pictures, std::function<bool()> mayRefine);

  /// After one was drawn into `window`.
  void followUp(ViewPicture& picture, vtkRenderWindow* window, const PaintSettings& settings);

  /// Seconds until what was drawn since this was asked before, and is shown elsewhere, is to be
  /// drawn again; 0: it is complete, or there is none.
  double takePause() { return std::exchange(this->Pause, 0); }
  /// What somebody else has made for `window` goes on in so many seconds; 0: it does not.
  void request(vtkRenderWindow* window, double pause);
  void cancel() { this->Timer.cancel(); }

private:
  PictureStore& Pictures;
  RefinementTimer Timer;
  double Pause = 0;
};

} // namespace inr
