// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Scene/PerView.h"
#include "Representations/Mapper/Pictures/ViewPicture.h"

#include <vtkWeakPointer.h>

#include <list>

class vtkRenderer;
class vtkVolume;

namespace inr {

/// The pictures of a mapper's views: each viewport has its own, and each eye of one in stereo. All
/// are drawn by turns, and none of them is the others' beginning.
class PictureStore
{
public:
  PictureStore() { this->Views.emplace_front(0); } // nobody's

  /// Views that each go on with their picture: no more than the renderer knows.
  static constexpr int Most = static_cast<int>(PerView<ViewPicture>::Most);

  /// That of a volume as a renderer shows it to the eye for which its camera looks; from now on the
  /// latest. Of more than Most, that of the view that was not drawn for longest makes room.
  ViewPicture& of(vtkRenderer* renderer, vtkVolume* volume);
  /// The same, null where there is none; it does not become the latest.
  const ViewPicture* find(vtkRenderer* renderer, vtkVolume* volume) const;
  /// That of `prop` or, where it is a prop that has others drawn for it, as in ParaView, the one
  /// drawn last in that renderer.
  const ViewPicture* findShown(vtkRenderer* renderer, vtkVolume* prop) const;
  /// An empty one before the first.
  const ViewPicture& latest() const { return this->Views.front().picture; }
  /// None is to be shown again.
  void outdate();

  /// Whether any has asked for its window to be drawn again, and was not drawn since.
  bool anyRequested() const;
  /// For when that is done: each that is drawn asks for itself again.
  void answerRequests();

private:
  struct View
  {
    explicit View(int number) : picture(number) {}
    bool isOf(vtkRenderer* renderer, vtkVolume* volume) const;

    vtkWeakPointer<vtkRenderer> renderer;
    vtkWeakPointer<vtkVolume> volume;
    bool leftEye = true;
    ViewPicture picture;
  };

  int freeNumber() const;

  std::list<View> Views; ///< the latest first; never none
};

} // namespace inr
