// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

enum class InstructionSet;
struct ModelView;

/// What a network's products are made of.
enum class InferencePrecision {
  Float32,
  /// Weights and what goes into a layer are rounded to 8 bits, sums are float32.
  BFloat16
};

/// Whether this build has kernels for `set` that compute so, and this processor runs them. Float32
/// always is.
bool IsUsable(InferencePrecision precision, InstructionSet set);

/// Whether no number that the network computes can come near the end of float's range, wherever it
/// is evaluated: by the largest magnitudes that features, weights and activations allow. Kernels
/// for bfloat16 cannot tell whether that happened.
bool StaysInRange(const ModelView& model);

} // namespace inr
