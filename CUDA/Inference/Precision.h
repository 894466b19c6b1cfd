// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {
namespace cuda {

/// What a GPU computes with.
enum class Precision {
  Half,    ///< parameters and layers' results are halves, sums are floats
  Float32, ///< everything is float32; in parts by tensor cores where model and GPU allow that
  Plain    ///< the same without tensor cores: for any model and any GPU, slower
};

} // namespace cuda
} // namespace inr
