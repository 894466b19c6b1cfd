// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Tolerance/LineKernel.h"
#include "Core/Render/Tolerance/ValueBox.h"

#include <functional>

namespace inr {

/// What samples along lines get wrong, each in the middle of the voxels that it is taken for.
struct LineErrors
{
  /// The largest of the sums over any part of any line of samples, times the distance between its
  /// voxels: errors that cancel each other do so here.
  float sum = 0;
  float magnitude = 0; ///< the same of the errors' magnitudes
  float largest = 0;   ///< error of a single value
};

/// Whether errors are so large that nobody wants to know if they are larger.
using IsTooLarge = std::function<bool(const LineErrors&)>;

/// Of all lines through a part of a box, along the edges and the diagonals of faces and of the
/// volume of a cube, with samples 2^power voxels apart (half of that along diagonals) on voxels and
/// between two, wherever the first may be. `fine`: values of level 0; `taken`: what samples have in
/// the same places. What samples near the box's ends are taken for has to be in it. Ends early,
/// with less than what it would have found, when that is too large.
LineErrors FindLineErrors(const ValueBox& fine, const ValueBox& taken, const GridBox& part,
                          int power, const LineKernel& kernel, const IsTooLarge& isTooLarge);

} // namespace inr
