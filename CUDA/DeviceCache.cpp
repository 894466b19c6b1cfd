// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/DeviceCache.h"

#include "CUDA/DeviceInference.h"

namespace inr {
namespace cuda {

template class DeviceCache<GpuMachine, DeviceInference>;

} // namespace cuda
} // namespace inr
