// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/Majorants.h"
#include "Core/Render/Ray.h"

#include <glm/common.hpp>

#include <limits>

namespace inr {

/// A ray's way through the macro-cells: the cell at t and where the ray leaves it. Both are
/// functions of ray and cell alone, so that a walk may stop and start again anywhere.
class CellWalker
{
public:
  INR_HOST_DEVICE CellWalker(const Majorants& majorants, const glm::dvec3& volumeDims,
                             const Ray& ray)
      : Cells(&majorants), Start((ray.entry + 0.5) / (volumeDims * majorants.spacing())),
        Slope(ray.direction / (volumeDims * majorants.spacing())), Inverse(1.0 / this->Slope)
  {}

  /// Moves to t, which does not fall from call to call.
  INR_HOST_DEVICE void moveTo(double t)
  {
    if (t >= this->Exit) {
      this->enterCellAt(t);
    }
  }
  INR_HOST_DEVICE const MajorantCell& cell() const { return *this->Current; }
  /// Where the ray enters the cell, at least 0, and where it leaves it; the outermost cells reach
  /// as far as any ray.
  INR_HOST_DEVICE double enter() const { return this->Enter; }
  INR_HOST_DEVICE double exit() const { return this->Exit; }

private:
  INR_HOST_DEVICE void enterCellAt(double t)
  {
    const glm::i64vec3 last = this->Cells->dims() - std::int64_t{1};
    // Not negative, so truncation is floor, which old instruction sets leave to a library.
    const glm::dvec3 place = glm::max(this->Start + this->Slope * t, glm::dvec3(0.0));
    const glm::i64vec3 cell = glm::min(glm::i64vec3(place), last);
    this->Enter = 0;
    this->Exit = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      if (this->Slope[axis] == 0) {
        continue;
      }
      const int ahead = this->Slope[axis] > 0 ? 1 : 0;
      const double lower = this->faceAt(axis, cell[axis] + 1 - ahead);
      const double upper = this->faceAt(axis, cell[axis] + ahead);
      this->Enter = glm::max(this->Enter, lower);
      if (ahead != 0 ? cell[axis] < last[axis] : cell[axis] > 0) {
        this->Exit = glm::min(this->Exit, upper);
      }
    }
    this->Current = &this->Cells->cell(cell);
  }

  /// t at which the ray crosses a plane between cells.
  INR_HOST_DEVICE double faceAt(int axis, std::int64_t plane) const
  {
    return (static_cast<double>(plane) - this->Start[axis]) * this->Inverse[axis];
  }

  const Majorants* Cells;
  const MajorantCell* Current = nullptr;
  glm::dvec3 Start; ///< in cells, at t = 0
  glm::dvec3 Slope; ///< cells per unit of t
  glm::dvec3 Inverse;
  double Enter = 0;
  double Exit = -1;
};

} // namespace inr
