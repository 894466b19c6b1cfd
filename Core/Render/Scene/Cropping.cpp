// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Scene/Cropping.h"

#include "Core/GridBox.h"

#include <glm/common.hpp>

#include <limits>

namespace inr {

CroppedBox BoxOf(const Cropping& cropping)
{
  constexpr double far = std::numeric_limits<double>::infinity();
  glm::ivec3 first(3);
  glm::ivec3 last(-1);
  int shown = 0;
  for (int k = 0; k < 27; ++k) {
    const glm::ivec3 region(k % 3, k / 3 % 3, k / 9);
    if (cropping.showsRegion(region)) {
      first = glm::min(first, region);
      last = glm::max(last, region);
      ++shown;
    }
  }
  if (shown == 0) {
    return {glm::dvec3(far), glm::dvec3(-far), true};
  }
  CroppedBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const double lowerEnds[] = {-far, cropping.low[axis], cropping.high[axis]};
    const double upperEnds[] = {cropping.low[axis], cropping.high[axis], far};
    box.low[axis] = lowerEnds[first[axis]];
    box.high[axis] = upperEnds[last[axis]];
  }
  const glm::ivec3 size = last - first + 1;
  box.full = shown == GridCount(size);
  return box;
}

} // namespace inr
