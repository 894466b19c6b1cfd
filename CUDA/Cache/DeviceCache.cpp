// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/DeviceCache.h"

#include "CUDA/Inference/DeviceInference.h"

namespace inr {
namespace cuda {

template class DeviceCache<GpuMachine, DeviceInference>;

} // namespace cuda
} // namespace inr
