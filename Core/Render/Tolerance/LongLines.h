// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Render/Tolerance/LineErrors.h"

#include <vector>

namespace inr {

/// FindLineErrors of all parts of a box that are up to 18 voxels long: in longer ones, lines
/// between the directions that are looked at are too far from any of these. Sums are the largest
/// that a straight line may meet part after part. Ends early, with less than what it would have
/// found, when that is too large.
LineErrors FindLongLineErrors(const ValueBox& fine, const ValueBox& taken, const GridBox& whole,
                              int power, const LineKernel& kernel, const IsTooLarge& isTooLarge);

/// The largest sum of numbers, none of them negative, of `count` boxes, x fastest, that a straight
/// line may pass one after the other. It goes the same way along an axis wherever it does.
float LargestAlongLines(const std::vector<float>& numbers, const glm::i64vec3& count);

} // namespace inr
