// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/LineKernel.h"
#include "Core/Cache/ValueBox.h"

namespace inr {

/// What samples get wrong along lines if one is taken for each 2^power voxels, in their middle.
struct LineErrors
{
  /// The largest of the sums over any part of any line, times the distance between its voxels:
  /// errors that cancel each other do so here.
  float sum = 0;
  float magnitude = 0; ///< the same of the errors' magnitudes
  float largest = 0;   ///< error of a single value
};

/// Of all lines of voxels through a part of a box, along the edges and the diagonals of faces and
/// of the volume of a cube. `fine`: values of level 0; `coarse`: what the level has in the same
/// places.
LineErrors FindLineErrors(const ValueBox& fine, const ValueBox& taken, const BoxPart& part,
                          int power, const LineKernel& kernel);

} // namespace inr
