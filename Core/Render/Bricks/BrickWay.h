// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/HierarchyView.h"
#include "Core/HostDevice.h"
#include "Core/Render/Bricks/BrickPath.h"
#include "Core/Render/MacroCells/LatticeWalker.h"
#include "Core/Render/Rays/Ray.h"

#include <glm/common.hpp>

namespace inr {

/// A ray's way through the bricks of one level.
class BrickWay
{
public:
  BrickWay() = default; ///< of no level
  INR_HOST_DEVICE BrickWay(const HierarchyView& hierarchy, int level, const Ray& ray)
      : Level(level), Stride(hierarchy.brickDims() - 1),
        LastVoxel(hierarchy.level(level).size - std::int64_t{1})
  {
    const HierarchyLevel& at = hierarchy.level(level);
    this->Bricks = LatticeWalker(at.bricks, ray.entry * at.brickScale + at.brickBias,
                                 ray.direction * at.brickScale, ray.inverse / at.brickScale);
  }

  INR_HOST_DEVICE int level() const { return this->Level; }
  /// As if made anew, of no level.
  INR_HOST_DEVICE void forget() { this->Level = -1; }
  /// To the brick at t, which does not fall from call to call.
  INR_HOST_DEVICE void moveTo(double t) { this->Bricks.moveTo(t); }
  INR_HOST_DEVICE BrickKey brick() const { return KeyOf({this->Level, this->Bricks.cell()}); }
  /// Where the ray enters and leaves it. The outermost bricks reach as far as the ray does.
  INR_HOST_DEVICE double enter() const { return this->Bricks.enter(); }
  INR_HOST_DEVICE double exit() const { return this->Bricks.exit(); }

  /// The way through the brick from t on, but for what is stored there; `along` in units of `step`.
  INR_HOST_DEVICE void findPath(double t, double step, BrickPath& path) const
  {
    const glm::dvec3 cell(this->Bricks.cell());
    const glm::dvec3 origin = (this->Bricks.at(t) - cell) * this->Stride;
    const glm::dvec3 direction = this->Bricks.slope() * (this->Stride * step);
    const glm::dvec3 last = glm::min(this->Stride, this->LastVoxel - cell * this->Stride);
    for (int axis = 0; axis < 3; ++axis) {
      path.origin[axis] = static_cast<float>(origin[axis]);
      path.direction[axis] = static_cast<float>(direction[axis]);
      path.last[axis] = static_cast<float>(last[axis]);
    }
  }

private:
  int Level = -1;
  glm::dvec3 Stride{0};    ///< voxels from brick to brick
  glm::dvec3 LastVoxel{0}; ///< of the level
  LatticeWalker Bricks;
};

} // namespace inr
