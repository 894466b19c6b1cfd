// SPDX-License-Identifier: BSD-3-Clause
//
// Constants alone: code built for one instruction set includes this, and so do the GPU's kernels.
#pragma once

namespace inr {

/// X becomes X (aI + bA + cA^2), A = X^T X, so many times, with these numbers (K. Jordan et al.,
/// "Muon", 2024). That leaves singular vectors as they are and takes every singular value from
/// 0.002 to 1 to one between 0.68 and 1.21: X becomes nearly orthogonal.
constexpr int NewtonSchulzRounds = 5;
constexpr float NewtonSchulzA = 3.4445f;
constexpr float NewtonSchulzB = -4.7750f;
constexpr float NewtonSchulzC = 2.0315f;

/// What is smaller than the largest element by this factor counts as zero: the rounds make at most
/// 485 times as much of it, and elements of A^2 would come to slow denormal numbers.
constexpr float NewtonSchulzNegligible = 1e-7f;

} // namespace inr
