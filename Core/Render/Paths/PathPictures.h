// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Paths/PathPicture.h"

#include <cstddef>
#include <list>

namespace inr {

/// Path-traced pictures in the making of one medium: one for each of the views that were drawn
/// last.
class PathPictures
{
public:
  /// Views that are drawn by turns and all go on: some viewports, in stereo. A picture takes 64
  /// bytes a pixel.
  static constexpr std::size_t Most = 8;

  /// That of a view (Frame::view), from now on the latest one; of more than Most, that of the view
  /// that was not drawn for longest makes room. Valid until the next call.
  PathPicture& of(int view);
  /// Forgets all, for when the medium changes.
  void reset() { this->Views.clear(); }

private:
  struct View
  {
    explicit View(int number) : view(number) {}
    int view;
    PathPicture picture;
  };

  std::list<View> Views; ///< the latest first
};

} // namespace inr
