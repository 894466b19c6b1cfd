// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Model/Description.h"

#include <cstdint>

namespace inr {

/// What is written into checkpoints: one by another optimiser would not go on to the same model. To
/// be changed with any of the numbers in here, in Optimiser.cpp, LearningRate.h,
/// AdamSchedule.{h,cpp} and NewtonSchulz.h.
constexpr const char* OptimiserName =
    "orthogonalised momentum, 0.95, 8 to 40 / sqrt t, up to 128; Adam, 0.9, 0.99 to 0.999";

/// Of Adam, and the L2 regularisation of those weights that it updates.
constexpr float AdamEpsilon = 1e-15f;
constexpr float WeightDecay = 1e-6f;

/// Share of a layer's momentum that every update keeps.
constexpr float MomentumKept = 0.95f;

/// The layers, from the first on, that are updated by orthogonalised momentum: the hidden ones,
/// unless they are wide. Adam's are the others, of which the last is a single row.
///
/// After 600 steps at 30:1, models of rm_mixing, heptane_fire and dft_si_charge_f64 are 0.2 to 1.6
/// dB nearer to the data than by Adam alone. In wide layers it would take a good part of a step:
/// its work grows with the cube of the width, that of a mini-batch with the square.
int OrthogonalisedLayers(const NetworkDescription& network);

/// min(8, 40 / sqrt(t)) for the t-th update, from 1 on: times the learning rate, what a nearly
/// orthogonal matrix is multiplied by, whatever its size. With a constant 0.8, rm_mixing and
/// dft_si_charge_f64 have 2 and 6 dB less after 100 steps, within half a dB as much after 3,000.
float OrthogonalRate(std::uint64_t update);

} // namespace inr
