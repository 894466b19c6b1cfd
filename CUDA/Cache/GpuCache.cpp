// SPDX-License-Identifier: BSD-3-Clause
#include "CUDA/Cache/GpuCache.h"

namespace inr {
namespace cuda {

template class DeviceCache<GpuMachine, DeviceInference>;

} // namespace cuda
} // namespace inr
