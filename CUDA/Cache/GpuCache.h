// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "CUDA/Cache/DeviceCache.h"
#include "CUDA/Inference/DeviceInference.h"

namespace inr {
namespace cuda {

/// That of a GPU, filled by it.
using GpuCache = DeviceCache<GpuMachine, DeviceInference>;

extern template class DeviceCache<GpuMachine, DeviceInference>;

} // namespace cuda
} // namespace inr
