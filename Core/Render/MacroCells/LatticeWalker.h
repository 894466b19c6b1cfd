// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/HostDevice.h"

#include <glm/common.hpp>
#include <glm/gtc/type_precision.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace inr {

/// A ray's way through the cells of a regular lattice, cell by cell (a digital differential
/// analyser in space, as Amanatides and Woo's, Eurographics 1987). Where the ray enters and leaves
/// a cell is a function of ray and cell alone, so that a walk may stop and start again anywhere.
/// The outermost cells reach as far as any ray.
class LatticeWalker
{
public:
  LatticeWalker() = default; ///< on no ray yet
  /// `dims` cells; at t the ray is in cell start + t * slope, rounded down. `inverse` is 1 / slope.
  INR_HOST_DEVICE LatticeWalker(const glm::i64vec3& dims, const glm::dvec3& start,
                                const glm::dvec3& slope, const glm::dvec3& inverse)
  {
    this->follow(dims, start, slope, inverse);
  }
  /// Begins anew on another ray.
  INR_HOST_DEVICE void follow(const glm::i64vec3& dims, const glm::dvec3& start,
                              const glm::dvec3& slope, const glm::dvec3& inverse)
  {
    this->Last = dims - std::int64_t{1};
    this->Start = start;
    this->Slope = slope;
    this->Inverse = inverse;
    this->Exit = -1;
  }
  /// Begins anew in another lattice, of `scale` times as many cells per length.
  INR_HOST_DEVICE void changeTo(const glm::i64vec3& dims, const glm::dvec3& scale)
  {
    this->follow(dims, this->Start * scale, this->Slope * scale, this->Inverse / scale);
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

  /// Into the next cell; false, and nothing else, when that is not before `end`.
  INR_HOST_DEVICE bool moveToNext(double end)
  {
    const bool moves = this->Exit < end;
    if (moves) {
      this->advance();
    }
    return moves;
  }

  /// Out of the aligned block of 2^block cells per axis around the present one, into the very cell
  /// that going cell by cell comes to; false, and nothing else, when that is not before `end`.
  INR_HOST_DEVICE bool leaveBlock(int block, double end)
  {
    glm::i64vec3 last; // cells before the ray leaves the block along each axis
    glm::dvec3 exits;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t low = (this->Cell[axis] >> block) << block;
      const std::int64_t high = low + (std::int64_t{1} << block) - 1;
      last[axis] = this->Slope[axis] > 0 ? glm::min(high, this->Last[axis]) : low;
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
    for (int axis = 0; axis < 3; ++axis) {
      this->findAxisExit(axis);
    }
    this->Enter = t;
    this->findExit();
    return true;
  }

  INR_HOST_DEVICE const glm::i64vec3& cell() const { return this->Cell; }
  INR_HOST_DEVICE double enter() const { return this->Enter; }
  INR_HOST_DEVICE double exit() const { return this->Exit; }
  /// Where the ray is at t, in cells, and how far it comes per unit of t.
  INR_HOST_DEVICE glm::dvec3 at(double t) const { return this->Start + t * this->Slope; }
  INR_HOST_DEVICE const glm::dvec3& slope() const { return this->Slope; }

private:
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
    const double face = this->faceAt(axis, cell + (forward ? 1 : 0));
    // Which way a ray goes is anybody's guess, so better no branches.
    const bool open = static_cast<int>(this->Slope[axis] == 0) |
                      static_cast<int>(cell == (forward ? this->Last[axis] : 0));
    return open ? Infinite : face;
  }

  INR_HOST_DEVICE void findAxisExit(int axis)
  {
    this->AxisExit[axis] = this->exitFrom(axis, this->Cell[axis]);
  }

  INR_HOST_DEVICE void findExit()
  {
    this->Exit = glm::min(glm::min(this->AxisExit[0], this->AxisExit[1]), this->AxisExit[2]);
  }

  /// The cell that holds t, by the planes that `advance` goes by, or one right before it.
  INR_HOST_DEVICE void enterAt(double t)
  {
    this->Enter = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t last = this->Last[axis];
      const double place = this->Start[axis] + this->Slope[axis] * t;
      this->Cell[axis] = place > 0 ? glm::min(static_cast<std::int64_t>(place), last) : 0;
      this->findAxisExit(axis);
      if (this->Slope[axis] != 0) {
        this->settle(axis, t);
      }
    }
    this->findExit();
  }

  /// Makes good what rounding did to the cell along an axis, should it be too far.
  INR_HOST_DEVICE void settle(int axis, double t)
  {
    const std::int64_t direction = this->directionAlong(axis);
    const std::int64_t forward = direction > 0 ? 1 : 0;
    const std::int64_t first = forward != 0 ? 0 : this->Last[axis];
    std::int64_t& cell = this->Cell[axis];
    while (cell != first && t < this->faceAt(axis, cell + 1 - forward)) {
      cell -= direction;
      this->findAxisExit(axis);
    }
    if (cell != first) {
      this->Enter = glm::max(this->Enter, this->faceAt(axis, cell + 1 - forward));
    }
  }

  /// The axis whose face comes first; of equal ones always the same.
  INR_HOST_DEVICE static int firstOf(const glm::dvec3& exits)
  {
    return exits[0] <= exits[1] ? (exits[0] <= exits[2] ? 0 : 2) : (exits[1] <= exits[2] ? 1 : 2);
  }

  /// Into the next cell; there is one while Exit is not Infinite.
  INR_HOST_DEVICE void advance()
  {
    const int axis = firstOf(this->AxisExit);
    this->Cell[axis] += this->directionAlong(axis);
    this->Enter = this->Exit;
    this->findAxisExit(axis);
    this->findExit();
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

  glm::i64vec3 Last{0};
  glm::dvec3 Start{0};
  glm::dvec3 Slope{0};
  glm::dvec3 Inverse{0};
  glm::dvec3 AxisExit{0}; ///< where the ray leaves the cell along each axis
  glm::i64vec3 Cell{0};
  double Enter = 0;
  double Exit = -1; ///< below 0: nowhere yet
};

} // namespace inr
