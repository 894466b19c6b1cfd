// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

/// What a ray does where the brick it wants is not there.
enum class OnMiss {
  UseCoarser, ///< read the nearest coarser level that is, and wish for the wanted one
  Approach,   ///< the same, but wish for the next level on the way from the coarser one
  Stop        ///< wait
};

} // namespace inr
