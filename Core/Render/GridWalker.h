// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"
#include "Core/Render/MajorantGrid.h"
#include "Core/Render/Ray.h"

#include <glm/common.hpp>

#include <limits>

namespace inr {

/// A grid of macro-cells over a volume.
struct CellScale
{
  const MajorantGrid* cells;
  glm::dvec3 edge;     ///< of a cell, in voxels
  glm::dvec3 perVoxel; ///< 1 / edge
};

INR_HOST_DEVICE inline CellScale MakeCellScale(const MajorantGrid& cells,
                                               const glm::dvec3& volumeDims)
{
  const glm::dvec3 edge = volumeDims * cells.spacing();
  return {&cells, edge, 1.0 / edge};
}

/// A ray's way through a grid of macro-cells, cell by cell. Where the ray enters and leaves a cell
/// is a function of ray and cell alone, so that a walk may stop and start again anywhere.
class GridWalker
{
public:
  GridWalker() = default; ///< on no ray yet
  INR_HOST_DEVICE GridWalker(const MajorantGrid& cells, const glm::dvec3& volumeDims,
                             const Ray& ray)
  {
    this->follow(ray, MakeCellScale(cells, volumeDims));
  }
  /// Begins anew on another ray.
  INR_HOST_DEVICE void follow(const Ray& ray, const CellScale& cells)
  {
    this->Cells = cells.cells;
    this->Start = (ray.entry + 0.5) * cells.perVoxel;
    this->Slope = ray.direction * cells.perVoxel;
    this->Inverse = ray.inverse * cells.edge;
    this->Exit = -1;
  }

  /// Begins anew in another grid.
  INR_HOST_DEVICE void changeTo(const MajorantGrid& cells)
  {
    const glm::dvec3 scale = this->Cells->spacing() / cells.spacing();
    this->Cells = &cells;
    this->Start *= scale;
    this->Slope *= scale;
    this->Inverse /= scale;
    this->Exit = -1;
  }

  /// Moves to t, which does not fall from call to call.
  INR_HOST_DEVICE void moveTo(double t)
  {
    if (this->Exit < 0) {
      this->enterAt(t);
    }
    while (t >= this->Exit) {
      this->advance();
    }
  }

  /// Moves to the first cell from here on that can be seen; false when none begins before `end`.
  INR_HOST_DEVICE bool moveToVisible(double end)
  {
    while (this->extinction() <= 0.0f) {
      if (!this->leaveEmpty(end)) {
        return false;
      }
    }
    return true;
  }

  INR_HOST_DEVICE float extinction() const { return this->Cells->extinction(this->Index); }
  INR_HOST_DEVICE const ValueRange& range() const { return this->Cells->range(this->Index); }
  INR_HOST_DEVICE const glm::i64vec3& cell() const { return this->Cell; }
  /// Where the ray enters the cell and where it leaves it; the outermost cells reach as far as any
  /// ray.
  INR_HOST_DEVICE double enter() const { return this->Enter; }
  INR_HOST_DEVICE double exit() const { return this->Exit; }

private:
  static constexpr double Never = std::numeric_limits<double>::infinity();

  /// t at which the ray crosses the plane below cell `plane`.
  INR_HOST_DEVICE double faceAt(int axis, std::int64_t plane) const
  {
    return (static_cast<double>(plane) - this->Start[axis]) * this->Inverse[axis];
  }

  INR_HOST_DEVICE std::int64_t directionAlong(int axis) const
  {
    return this->Slope[axis] > 0 ? 1 : -1;
  }

  /// t at which the ray leaves the slab of cells `cell` along an axis.
  INR_HOST_DEVICE double exitFrom(int axis, std::int64_t cell) const
  {
    const bool forward = this->Slope[axis] > 0;
    const std::int64_t last = forward ? this->Cells->dims()[axis] - 1 : 0;
    const double face = this->faceAt(axis, cell + (forward ? 1 : 0));
    // Which way a ray goes is anybody's guess, so better no branches.
    const bool open = static_cast<int>(this->Slope[axis] == 0) | static_cast<int>(cell == last);
    return open ? Never : face;
  }

  INR_HOST_DEVICE void findAxisExit(int axis)
  {
    this->AxisExit[axis] = this->exitFrom(axis, this->Cell[axis]);
  }

  INR_HOST_DEVICE void findExit()
  {
    this->Exit = glm::min(glm::min(this->AxisExit[0], this->AxisExit[1]), this->AxisExit[2]);
  }

  /// The cell that holds t, by the planes that `advance` goes by.
  INR_HOST_DEVICE void enterAt(double t)
  {
    this->Enter = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t last = this->Cells->dims()[axis] - 1;
      const double place = this->Start[axis] + this->Slope[axis] * t;
      std::int64_t cell = place > 0 ? glm::min(static_cast<std::int64_t>(place), last) : 0;
      if (this->Slope[axis] != 0) {
        const int ahead = this->Slope[axis] > 0 ? 1 : 0;
        const int back = 1 - ahead;
        const std::int64_t against = ahead - back;
        const std::int64_t first = ahead != 0 ? 0 : last;
        while (cell != first && t < this->faceAt(axis, cell + back)) {
          cell -= against;
        }
        if (cell != first) {
          this->Enter = glm::max(this->Enter, this->faceAt(axis, cell + back));
        }
      }
      this->Cell[axis] = cell;
      this->findAxisExit(axis);
    }
    this->Index = this->Cells->index(this->Cell);
    this->findExit();
  }

  /// The axis whose face comes first; of equal ones always the same.
  INR_HOST_DEVICE static int firstOf(const glm::dvec3& exits)
  {
    return exits[0] <= exits[1] ? (exits[0] <= exits[2] ? 0 : 2) : (exits[1] <= exits[2] ? 1 : 2);
  }

  /// Into the next cell; there is one while Exit is not Never.
  INR_HOST_DEVICE void advance()
  {
    const int axis = firstOf(this->AxisExit);
    const glm::i64vec3& dims = this->Cells->dims();
    const std::int64_t stride = axis == 0 ? 1 : (axis == 1 ? dims.x : dims.x * dims.y);
    const std::int64_t direction = this->directionAlong(axis);
    this->Cell[axis] += direction;
    this->Index += direction * stride;
    this->Enter = this->Exit;
    this->findAxisExit(axis);
    this->findExit();
  }

  /// Out of an invisible cell or the block of such around it, into the very cell that going cell by
  /// cell comes to; false, and nothing else, when that is not before `end`.
  INR_HOST_DEVICE bool leaveEmpty(double end)
  {
    constexpr int worthwhile = 2; // smaller blocks are left sooner cell by cell
    const int block = this->Cells->emptyBlock(this->Index);
    if (block >= worthwhile) {
      return this->leaveBlock(block, end);
    }
    if (this->Exit >= end) {
      return false;
    }
    this->advance();
    return true;
  }

  INR_HOST_DEVICE bool leaveBlock(int block, double end)
  {
    glm::i64vec3 last; // cells before the ray leaves the block along each axis
    glm::dvec3 exits;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t low = (this->Cell[axis] >> block) << block;
      const std::int64_t high = low + (std::int64_t{1} << block) - 1;
      last[axis] = this->Slope[axis] > 0 ? glm::min(high, this->Cells->dims()[axis] - 1) : low;
      exits[axis] = this->exitFrom(axis, last[axis]);
    }
    const int through = firstOf(exits);
    const double t = exits[through];
    if (t >= end) {
      return false;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != through && this->Slope[axis] != 0) {
        this->Cell[axis] = this->cellAt(axis, last[axis], t, axis < through);
      }
    }
    this->Cell[through] = last[through] + this->directionAlong(through);
    this->Index = this->Cells->index(this->Cell);
    for (int axis = 0; axis < 3; ++axis) {
      this->findAxisExit(axis);
    }
    this->Enter = t;
    this->findExit();
    return true;
  }

  /// The cell along an axis, from the present one to `last`, at t; a face right at t has been
  /// passed or not.
  INR_HOST_DEVICE std::int64_t cellAt(int axis, std::int64_t last, double t, bool passed) const
  {
    const std::int64_t direction = this->directionAlong(axis);
    const std::int64_t first = this->Cell[axis];
    const auto behind = [&](std::int64_t cell) {
      const double exit = this->exitFrom(axis, cell);
      return passed ? exit <= t : exit < t;
    };
    const auto low = static_cast<double>(glm::min(first, last));
    const auto high = static_cast<double>(glm::max(first, last));
    const double place = this->Start[axis] + this->Slope[axis] * t;
    auto cell = static_cast<std::int64_t>(glm::clamp(place, low, high)); // but for rounding
    while (cell != last && behind(cell)) {
      cell += direction;
    }
    while (cell != first && !behind(cell - direction)) {
      cell -= direction;
    }
    return cell;
  }

  const MajorantGrid* Cells = nullptr;
  glm::dvec3 Start{0}; ///< in cells, at t = 0
  glm::dvec3 Slope{0}; ///< cells per unit of t
  glm::dvec3 Inverse{0};
  glm::dvec3 AxisExit{0}; ///< where the ray leaves the cell along each axis
  glm::i64vec3 Cell{0};
  std::int64_t Index = 0;
  double Enter = 0;
  double Exit = -1; ///< below 0: nowhere yet
};

} // namespace inr
