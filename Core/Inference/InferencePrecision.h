// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

enum class InstructionSet;
struct ModelView;

/// What a network's products are made of.
enum class InferencePrecision {
  Float32,
  /// Weights and what goes into a layer are rounded to 8 bits, sums are float32.
  BFloat16,
  /// The same of sums of two such numbers, which are 16 bits: three products for one.
  SplitBFloat16
};

/// Whether this build has kernels for `set` that compute so, and this processor runs them. Float32
/// always is; SplitBFloat16 pays with tile registers only, which go with AVX-512.
bool IsUsable(InferencePrecision precision, InstructionSet set);

/// Whether no value that the network computes can come near either end of float's range, wherever
/// it is evaluated (what squareplus squares on the way may, and is watched): by the largest
/// magnitudes that features, weights and activations allow, none is too large, and what is below
/// 2^-126 counts for at most 2^-30 of a value y. Kernels for bfloat16 cannot tell whether a number
/// was too large, and take one that small for zero.
bool StaysInRange(const ModelView& model);

} // namespace inr
