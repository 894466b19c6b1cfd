// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Training/Trainer.h"

#include <cstdint>

namespace inr {

/// How a limit on memory is divided when a volume is trained from pieces.
struct StreamBudget
{
  Description description;
  std::int64_t blockVoxels = 0; ///< that are read at a time
  std::int64_t poolSamples = 0;
};

/// Bytes that training a model takes beyond the volume: its parameters, what the optimiser keeps of
/// them, and a mini-batch on its way. `accelerated`: with a second copy of what comes from the
/// device.
std::int64_t TrainingBytes(const Description& description, bool accelerated = false);

/// The model is the one that the options ask for, or else the default one, made as much smaller as
/// the limit demands. `options.memoryLimit` is for each of so many processes. Throws
/// Error(InvalidArgument) that names the figures where `options.memoryLimit` cannot hold the
/// training of the model that was asked for, or the ranges of so many macro-cells; what
/// CountMacroCells throws.
StreamBudget PlanStream(const VolumeInfo& info, const TrainingOptions& options,
                        std::int64_t bytesPerVoxel, int processes = 1);

} // namespace inr
