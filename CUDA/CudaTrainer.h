// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Device.h"
#include "Core/Training/Descent/TrainingAccelerator.h"

#include <memory>
#include <string>

namespace inr {
namespace cuda {

/// A GPU for trainings, in float32.
std::shared_ptr<const TrainingAccelerator> MakeTrainer(const Device& device);

/// What is to be had for trainings.
struct FoundTrainer
{
  std::shared_ptr<const TrainingAccelerator> accelerator; ///< may be null
  std::string reason;                                     ///< why it is
};
/// The GPU of the `localRank`-th process on this machine. Never throws for want of one.
FoundTrainer FindTrainer(int localRank);

} // namespace cuda
} // namespace inr
