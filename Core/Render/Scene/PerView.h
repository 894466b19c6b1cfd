// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <list>

namespace inr {

/// Something of which each of the views that were drawn last has one of its own, as pictures that
/// are in the making.
template <class T> class PerView
{
public:
  /// Views that are drawn by turns and all go on: some viewports, in stereo. Beside them there may
  /// be one that is nobody's.
  static constexpr std::size_t Most = 8;

  /// That of a view (Frame::view), from now on the latest one, as T makes it at first; of more than
  /// these, that of the view that was not drawn for longest makes room. Valid until the next call.
  T& of(int view)
  {
    const auto found = std::find_if(this->Views.begin(), this->Views.end(),
                                    [view](const View& one) { return one.view == view; });
    if (found != this->Views.end()) {
      this->Views.splice(this->Views.begin(), this->Views, found);
    } else {
      if (this->Views.size() > Most) { // before there is one more
        this->Views.pop_back();
      }
      this->Views.emplace_front(view);
    }
    return this->Views.front().value;
  }
  /// Forgets that of a view.
  void forget(int view)
  {
    this->Views.remove_if([view](const View& one) { return one.view == view; });
  }
  /// Forgets all.
  void reset() { this->Views.clear(); }

private:
  struct View
  {
    explicit View(int number) : view(number) {}
    int view;
    T value;
  };

  std::list<View> Views; ///< the latest first
};

} // namespace inr
