// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/StillPictures.h"

#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <algorithm>

namespace inr {

double TimeLimit(vtkRenderer* renderer, const PaintSettings& settings)
{
  constexpr double glance = 0.5; // what a user waits for without noticing
  vtkRenderWindow* window = renderer->GetRenderWindow();
  if (IsInteractive(window)) {
    return glance / window->GetDesiredUpdateRate();
  }
  const bool isWatched = renderer->GetSelector() || settings.forSelection
                             ? RefinementTimer::isWatched(window)
                             : RefinementTimer::canRefine(window);
  if (!isWatched && !settings.shownElsewhere) {
    return 0;
  }
  return settings.stillTimeLimit >= 0 ? settings.stillTimeLimit : glance; // no number is no wish
}

StillPictures::StillPictures(PictureStore& pictures, std::function<bool()> mayRefine)
    : Pictures(pictures), Timer(std::move(mayRefine), [this] { this->Pictures.answerRequests(); })
{}

void StillPictures::followUp(ViewPicture& picture, vtkRenderWindow* window,
                             const PaintSettings& settings)
{
  if (IsInteractive(window)) {
    this->Timer.postpone(); // what follows an interactive picture is the application's business
    return;
  }
  const bool shownElsewhere = settings.shownElsewhere && !settings.forSelection;
  if (!shownElsewhere && !RefinementTimer::canRefine(window)) {
    return; // captured; what is on the screen goes on afterwards
  }
  const PaintedFrame& last = picture.last();
  picture.goesOn = false;
  picture.requested = !last.rgba.pixels.empty() && !last.statistics.complete;
  if (!this->Pictures.anyRequested()) {
    this->Timer.cancel();
  }
  if (!picture.requested) {
    return;
  }
  // Bricks are decoded in the pause, too; other work is done within pictures only.
  const bool waitsForBricks = settings.mode != RenderMode::PathTracing && !last.statistics.blank;
  const double share = waitsForBricks ? 1 : 0.25;
  const double least = picture.hurried ? 0.3 : 0.02; // the next may come meanwhile
  const double pause = std::clamp(share * last.seconds, least, 0.5);
  if (shownElsewhere) {
    this->Pause = std::max(this->Pause, pause); // of both eyes
  } else {
    this->Timer.request(window, pause);
  }
}

void StillPictures::request(vtkRenderWindow* window, double pause)
{
  if (pause > 0 && window && window->GetInteractor()) { // which tells the time
    this->Timer.request(window, pause);
  } else {
    this->Timer.cancel();
  }
}

} // namespace inr
