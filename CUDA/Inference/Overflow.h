// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Cache/BrickSource.h"

namespace inr {
namespace cuda {

/// Kernels mark a sample as NaN where a number left the range of what they compute with: finite
/// parameters give no other. These values are computed again by Core, for which nothing is too
/// large. Returns how many there were.
std::int64_t RepairPoints(const Evaluator& core, const glm::vec3* positions, std::int64_t count,
                          float* values);

/// The same for `layers` layers of a brick, from the `z`-th on.
std::int64_t RepairLayers(const BrickSource& core, BrickKey key, std::int64_t z,
                          std::int64_t layers, float* values);

} // namespace cuda
} // namespace inr
