// SPDX-License-Identifier: BSD-3-Clause
#include "Core/Render/Paths/PathTracingGeometry.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace inr {

InnerRays::InnerRays(const Frame& frame, const RayGeometry& geometry, const glm::i64vec3& dims,
                     std::vector<glm::dvec4>& planes)
    : ToWorld(glm::inverse(frame.worldToIndex)), ToIndex(frame.worldToIndex),
      Unit(geometry.view().unit)
{
  for (int axis = 0; axis < 3; ++axis) {
    this->Low[axis] = dims[axis] == 1 ? -0.5 : 0.0;
    this->High[axis] = dims[axis] == 1 ? 0.5 : static_cast<double>(dims[axis] - 1);
  }
  if (frame.cropping) { // to a box
    const CroppedBox box = BoxOf(*frame.cropping);
    this->Low = glm::max(this->Low, box.low);
    this->High = glm::min(this->High, box.high);
  }
  planes.clear();
  for (const glm::dvec4& plane : frame.clippingPlanes) {
    planes.push_back(glm::transpose(this->ToWorld) * plane);
  }
  this->Planes = planes.data();
  this->PlaneCount = static_cast<int>(planes.size());
}

} // namespace inr
