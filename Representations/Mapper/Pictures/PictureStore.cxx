// SPDX-License-Identifier: BSD-3-Clause
#include "Representations/Mapper/Pictures/PictureStore.h"

#include <vtkCamera.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>

#include <algorithm>
#include <utility>

namespace inr {

namespace {

bool LooksLeft(vtkRenderer* renderer) { return renderer->GetActiveCamera()->GetLeftEye() != 0; }

} // namespace

bool PictureStore::View::isOf(vtkRenderer* shownIn, vtkVolume* shown) const
{
  return this->renderer == shownIn && this->volume == shown && this->leftEye == LooksLeft(shownIn);
}

ViewPicture& PictureStore::of(vtkRenderer* renderer, vtkVolume* volume)
{
  const auto found = std::find_if(this->Views.begin(), this->Views.end(),
                                  [&](const View& view) { return view.isOf(renderer, volume); });
  if (found != this->Views.end()) {
    this->Views.splice(this->Views.begin(), this->Views, found);
  } else {
    View& view = this->Views.emplace_front(this->freeNumber());
    view.renderer = renderer;
    view.volume = volume;
    view.leftEye = LooksLeft(renderer);
  }
  this->Views.remove_if([](const View& view) { return !view.renderer || !view.volume; });
  if (this->Views.size() > Most) {
    this->Views.pop_back();
  }
  return this->Views.front().picture;
}

const ViewPicture* PictureStore::find(vtkRenderer* renderer, vtkVolume* volume) const
{
  const auto found = std::find_if(this->Views.begin(), this->Views.end(),
                                  [&](const View& view) { return view.isOf(renderer, volume); });
  return found != this->Views.end() ? &found->picture : nullptr;
}

const ViewPicture* PictureStore::findShown(vtkRenderer* renderer, vtkVolume* prop) const
{
  if (const ViewPicture* own = this->find(renderer, prop)) {
    return own;
  }
  const auto found = std::find_if(this->Views.begin(), this->Views.end(), [&](const View& view) {
    return view.isOf(renderer, view.volume);
  });
  return found != this->Views.end() ? &found->picture : nullptr;
}

int PictureStore::freeNumber() const
{
  int number = 0;
  const auto isTaken = [&](const View& view) { return view.picture.number() == number; };
  while (std::any_of(this->Views.begin(), this->Views.end(), isTaken)) {
    ++number;
  }
  return number;
}

void PictureStore::outdate()
{
  for (View& view : this->Views) {
    view.picture.outdate();
  }
}

bool PictureStore::anyRequested() const
{
  return std::any_of(this->Views.begin(), this->Views.end(), [](const View& view) {
    return view.picture.requested || view.picture.goesOn;
  });
}

void PictureStore::answerRequests()
{
  for (View& view : this->Views) {
    view.picture.goesOn = std::exchange(view.picture.requested, false);
  }
}

} // namespace inr
