// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace inr {

struct InferenceKernels;

/// Whether two ways to compute with bfloat16 give the same at some points and on a lattice, of
/// models all of whose sums are exact in float32: in whatever order they come about, kernels that
/// work then give the same to the last bit, as the bound in Evaluator.h is of what rounding loses.
bool GiveTheSame(const InferenceKernels& some, const InferenceKernels& others);

} // namespace inr
