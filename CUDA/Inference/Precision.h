// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {
namespace cuda {

/// What a GPU computes with.
enum class Precision {
  Half,   ///< parameters and layers' results are halves, sums are floats: tensor cores, fused
  Float32 ///< everything float32: any model, slower
};

} // namespace cuda
} // namespace inr
