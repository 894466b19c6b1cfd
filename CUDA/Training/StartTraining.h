// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Device/Device.h"
#include "Core/Training/Descent/TrainingAccelerator.h"

#include <memory>

namespace inr {
namespace cuda {

/// Begins a training on a GPU. Throws Error(Device) with figures where its memory is short or it
/// fails.
std::unique_ptr<AcceleratedTraining> StartTraining(const Device& device, const TrainingTask& task);

} // namespace cuda
} // namespace inr
