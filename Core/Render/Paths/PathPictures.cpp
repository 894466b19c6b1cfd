// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/PathPictures.h"

#include <algorithm>

namespace inr {

PathPicture& PathPictures::of(int view)
{
  const auto found = std::find_if(this->Views.begin(), this->Views.end(),
                                  [view](const View& one) { return one.view == view; });
  if (found != this->Views.end()) {
    this->Views.splice(this->Views.begin(), this->Views, found);
  } else {
    if (this->Views.size() == Most) { // before there is one more
      this->Views.pop_back();
    }
    this->Views.emplace_front(view);
  }
  return this->Views.front().picture;
}

} // namespace inr
